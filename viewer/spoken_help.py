"""The help of the path options in the reader's language: the words that the viewer has for the settings."""

from cyclopts.help import DefaultFormatter

from tracer.settings import Settings
from viewer.words import Speaker

PATH_OPTIONS = "Path options"  # the group of those that are made from the settings


class SpokenFormatter(DefaultFormatter):
    """Draws panels; that of the path options, which are declared in English, in the reader's language."""

    def __call__(self, console, options, panel):
        say = Speaker()
        if panel.title == PATH_OPTIONS and say.language != "en":
            entries = [entry.copy(description=_meaning(entry, say)) for entry in panel.entries]
            panel = panel.copy(title=say("help.path_options"), entries=entries)
        super().__call__(console, options, panel)


def _meaning(entry, say):
    """What an option means, and its choices."""
    name = entry.positive_names[0].removeprefix("--").replace("-", "_")
    field = Settings.__dataclass_fields__.get(name)
    choices = field.metadata["choices"] if field else ()
    meaning = say.optional(f"setting.{name}", entry.description)
    return say("help.choices", meaning=meaning, choices=", ".join(map(str, choices))) if choices else meaning
