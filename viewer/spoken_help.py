"""The help of a command in the reader's language: English stands with the options, others in tables."""

from cyclopts.help import DefaultFormatter
from cyclopts.help.specs import (
    DescriptionColumn,
    DescriptionRenderer,
    get_default_command_columns,
    get_default_parameter_columns,
)

from tracer.settings import Settings
from viewer.words import Speaker

PATH_OPTIONS = "Path options"  # the group of those that are made from the settings


class SpokenFormatter(DefaultFormatter):
    """Draws the help of one command, or of all of them ("")."""

    def __init__(self, command=""):
        super().__init__()
        self.command = command

    def render_usage(self, console, options, usage):
        """The line of usage."""
        from rich.text import Text

        console.print(Text(Speaker()("help.usage", usage=str(usage)), "cyclopts.usage"))

    def __call__(self, console, options, panel):
        """One panel."""
        say = Speaker()
        of_settings = panel.title == PATH_OPTIONS
        if of_settings:
            panel = panel.copy(title=say("help.path_options"))
        if say.language != "en":
            entries = [
                entry.copy(description=self._meaning(entry, of_settings, say)) for entry in panel.entries
            ]
            panel = panel.copy(entries=entries)
        self.column_specs = _columns(panel.format, say)
        super().__call__(console, options, panel)

    def _meaning(self, entry, of_settings, say):
        """What an option, an argument or a command means; of an option its choices, too."""
        name = name_of(entry)
        keys = (f"option.{self.command}.{name}", f"setting.{name}", f"option.{name}", f"command.{name}")
        meaning = next((say.words[key] for key in keys if key in say.words), entry.description)
        field = Settings.__dataclass_fields__.get(name) if of_settings else None
        choices = field.metadata["choices"] if field else ()
        if not choices:
            return meaning
        return say("help.choices", meaning=meaning, choices=say.listed(*map(str, choices)))


def name_of(entry):
    """The name under which the tables have an option, an argument or a command."""
    shown = entry.positive_names[0] if entry.positive_names else entry.positional_label
    return shown.removeprefix("--").replace("-", "_").lower()


class _Meaning(DescriptionRenderer):
    """What a thing means, and after it what holds unless it is given. Of a flag that is off, nothing."""

    def __init__(self, say):
        super().__init__()
        self.say = say

    def __call__(self, entry):
        from rich.text import Text

        from viewer.folded import Folded

        default = entry.positive_names[0] if entry.default == "True" else entry.default
        more = []
        if default not in (None, "False"):
            more.append(Text(self.say("help.default", value=default), "cyclopts.default"))
        if entry.required:
            more.append(Text(self.say("help.required"), "cyclopts.required"))
        if isinstance(entry.description, str):
            return Folded(Text(" ").join([Text(entry.description), *more]))
        shown = super().__call__(entry.copy(default=None, required=False))
        for words in more:
            shown.append(words)
        return shown


def _columns(kind, say):
    """Makes the columns of a panel of that kind, as cyclopts does, with meanings of our own."""
    made = get_default_command_columns if kind == "command" else get_default_parameter_columns

    def columns(console, options, entries):
        ours = DescriptionColumn.copy(renderer=_Meaning(say))
        return tuple(ours if c is DescriptionColumn else c for c in made(console, options, entries))

    return columns
