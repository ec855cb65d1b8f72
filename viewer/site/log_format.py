"""The format of logs of other tracers, as `castray log --schema` prints it."""

from html import escape

from tracer.trace.jsonl import schema_text
from viewer.site.frame import framed, named

STEM = "log-format"


def file_of(language):
    """The page's file."""
    return named(STEM, language)


def page(say):
    """The page, in the language of say."""
    main = (
        f"<h1>{escape(say('site.log'))}</h1><p>{escape(say('site.log_about'))} "
        f"<code>castray log --header castray.h</code></p><pre>{escape(schema_text(say.optional))}</pre>"
    )
    return framed(say("site.log"), main, STEM, say.language, wide=True)
