"""The first page: every lesson with its title, how long it takes, and what is beside them."""

from html import escape

from lessons.course import lessons
from viewer.site import lesson_page, log_format
from viewer.site.frame import framed, named


def file_of(language):
    """The file of the index."""
    return named("index", language)


def page(say):
    """The index in one language."""
    rows = "".join(_row(it, say) for it in lessons().values())
    heads = "".join(f"<th>{escape(say(key))}</th>" for key in ("lesson.lesson", "lesson.time", "site.tasks"))
    main = (
        f"<h1>{escape(say('site.title'))}</h1><p>{escape(say('site.intro'))} <code>castray view --lesson 1</code></p>"
        f'<table class="lessons"><thead><tr><th></th>{heads}</tr></thead><tbody>{rows}</tbody></table>'
        f"<h2>{escape(say('site.beside'))}</h2><ul>"
        f'<li><a href="{named("formulas", say.language)}">{escape(say("site.formulas"))}</a><br>{escape(say("site.formulas_about"))}</li>'
        f'<li><a href="reference.html">{escape(say("site.reference"))}</a><br>{escape(say("site.reference_about"))}</li>'
        f'<li><a href="{log_format.file_of(say.language)}">{escape(say("site.log"))}</a><br>{escape(say("site.log_about"))}</li></ul>'
    )
    return framed(say("site.title"), main, "index", say.language)


def _row(it, say):
    title = escape(it.words[say.language].title)
    return (
        f'<tr><td class="number">{it.number:02}</td><td><a href="{lesson_page.file_of(it, say.language)}">{title}</a></td>'
        f"<td>{escape(say('lesson.minutes', n=it.minutes))}</td><td>{len(it.tasks)}</td></tr>"
    )
