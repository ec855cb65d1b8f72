"""The format of logs of other tracers, as `castray log --schema` prints it."""

from html import escape

from tracer.trace.jsonl import schema_text
from viewer.site.frame import framed
from viewer.words import Speaker


def page():
    """The page, in English."""
    say = Speaker("en")
    main = (
        f"<h1>{escape(say('site.log'))}</h1><p>{escape(say('site.log_about'))} "
        f"<code>castray log --header castray.h</code></p><pre>{escape(schema_text())}</pre>"
    )
    return framed(say("site.log"), main, "log-format", "en", wide=True)
