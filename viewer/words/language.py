"""Which language: of the terminal by --lang or the environment, of a page by its browser."""

from contextvars import ContextVar

LANGUAGES = {"en": "English", "zh": "中文"}
# In the order in which they decide. LANGUAGE may list several, the first known one counts.
ENVIRONMENT = ("LANGUAGE", "LC_ALL", "LC_MESSAGES", "LANG")

_OF_THE_TERMINAL: ContextVar[str] = ContextVar("language", default="en")


def current():
    """The language of the terminal."""
    return _OF_THE_TERMINAL.get()


def use(language):
    """From now on the terminal's language is this one."""
    _OF_THE_TERMINAL.set(language)


def asked(environment):
    """The language that the environment asks for, English where it asks for none that is known."""
    for name in ENVIRONMENT:
        known = [known_as(tag) for tag in environment.get(name, "").split(":") if tag]
        if any(known):
            return next(filter(None, known))
        if known:
            return "en"
    return "en"


def known_as(tag):
    """The known language that a tag such as zh_CN.UTF-8 or zh-Hans names, None if none."""
    name = tag.replace("_", "-").partition("-")[0].partition(".")[0].lower()
    return name if name in LANGUAGES else None
