"""From theory to code: each formula of the lessons, the function that computes it, the test that proves it."""

from html import escape

from lessons.course import lessons
from lessons.html import mathml
from lessons.words import labels
from viewer.site import lesson_page
from viewer.site.frame import framed, named
from viewer.site.reference import anchor, source


def file_of(language):
    """The file of the map."""
    return named("formulas", language)


def page(say):
    """The map in one language."""
    heads = [say(f"site.{key}") for key in ("formula", "function", "test")]
    head = "".join(f"<th>{escape(text)}</th>" for text in heads)
    parts = "".join(_lesson(it, head, say) for it in lessons().values())
    main = f"<h1>{escape(say('site.formulas'))}</h1><p>{escape(say('site.formulas_about'))}</p>{parts}"
    return framed(say("site.formulas"), main, "formulas", say.language, wide=True)


def formulas(it):
    """(Formula, LaTeX) of a lesson, in the order of its text."""
    texts = (text for _, text in it.words["en"].texts)
    return [(it.formulas[label], latex) for text in texts for label, latex in labels(text).items()]


def _lesson(it, head, say):
    title = say("lesson.head", number=it.number, title=it.words[say.language].title)
    rows = "".join(_row(it, formula, latex, say) for formula, latex in formulas(it))
    return f'<h2>{escape(title)}</h2><table class="map"><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>'


def _row(it, formula, latex, say):
    where = f"{lesson_page.file_of(it, say.language)}#formula-{formula.label}"
    file, _, test = formula.test.partition("::")
    return (
        f'<tr id="{it.number:02}-{formula.label}"><td>{mathml(latex, True)}<a href="{where}">{escape(formula.label)}</a></td>'
        f'<td><a href="reference.html#{anchor(formula.function)}"><code>{escape(formula.function)}</code></a>'
        f'<br><span class="dim">{escape(source(formula.computed))}</span></td>'
        f'<td><code>{escape(test)}</code><br><span class="dim">{escape(file)}</span></td></tr>'
    )
