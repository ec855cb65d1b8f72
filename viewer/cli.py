"""The `castray` command. What one command needs is imported when it runs: `--help` waits for none of it."""

import os
import sys
import warnings

from cyclopts import App, CycloptsError, Group, MissingArgumentError

from tracer.settings import TracerError
from viewer.spoken_help import SpokenFormatter
from viewer.words import LANGUAGES, Speaker, asked, use

# Its module in viewer/commands/ has a function of that name; what it does is told by the table of words.
COMMANDS = (
    "view", "render", "inspect", "doctor", "twin", "query", "diff", "check", "bsdf", "bench", "export", "log",
    "bugs", "lesson",
)  # fmt: skip

# What follows a command that needs something, as in the README.
EXAMPLES = {
    "render": "cornell", "inspect": "cornell", "doctor": "cornell", "twin": "cornell --bug D01",
    "diff": "a.exr b.exr", "check": "my_tracer.py", "export": "cornell",
}  # fmt: skip

# Options that take several numbers, and such numbers.
VALUES = {"--pixel": "50 57", "--size": "64 64"}


def _version():
    from importlib.metadata import version

    return version("castray")


def command_line(say):
    """The command line, its help in one language."""
    app = App(
        name="castray",
        help=f"{say('command')}\n\n{say('command.begin')}\n\n{say('command.lang')}",
        help_format="plaintext",
        version=_version,
        group_commands=say("help.commands"),
        group_arguments=Group(say("help.arguments"), sort_key=1),
        group_parameters=Group(say("help.parameters"), sort_key=2),
        help_formatter=SpokenFormatter(),
    )
    for name in COMMANDS:  # their docstrings are wrapped anew, which plain text is not
        module = f"viewer.commands.{name}:{name}"
        spoken = {"help": say(f"command.{name}"), "help_format": "markdown"}
        app.command(module, name=name, help_formatter=SpokenFormatter(name), **spoken)
    return app


def _language(words):
    """The language asked for by --lang, or by the environment; and the other words."""
    left, found = [], asked(os.environ)
    while words:
        word, *words = words
        name, equals, tag = word.partition("=")
        if name != "--lang":
            left.append(word)
            continue
        if not equals:
            tag, *words = words or [""]
        if tag not in LANGUAGES:
            raise TracerError(f"lang: {tag!r} is not known; choose one of {', '.join(LANGUAGES)}")
        found = tag
    return found, left


def _say(message):
    """A message as one line on standard error; what is not to be seen, as its code."""
    line = " ".join(str(message).split())
    shown = (c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in line)
    print(f"castray: {''.join(shown)}", file=sys.stderr)


def _told(error):
    """An error in one line; of what a command lacks, with an example."""
    line = " ".join(str(error).split())
    command = (getattr(error, "command_chain", None) or ("",))[0]
    name = getattr(getattr(error, "argument", None), "name", "")
    if isinstance(error, MissingArgumentError) and name in VALUES and command in COMMANDS:
        what = f" {EXAMPLES[command]}" if command in EXAMPLES else ""
        return (
            f"{command}: {name} takes {VALUES[name].count(' ') + 1} numbers; for example: "
            f"castray {command}{what} {name} {VALUES[name]}"
        )
    if isinstance(error, MissingArgumentError) and command in EXAMPLES and not name.startswith("-"):
        return f"{command}: {name} is missing; for example: castray {command} {EXAMPLES[command]}"
    return line


def main(words=None):
    """Run `castray WORDS`. Bad input is one line on standard error and exit code 2."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")  # a terminal that lacks a character shows "?"
    try:
        with warnings.catch_warnings():
            warnings.showwarning = lambda warning, *_: _say(Speaker().error(str(warning)))
            language, words = _language([*(sys.argv[1:] if words is None else words)])
            use(language)
            if words[:1] == ["help"]:
                words = [*words[1:], "--help"]
            code = command_line(Speaker())(words, exit_on_error=False, print_error=False)
    except (TracerError, CycloptsError) as error:
        _say(Speaker().error(_told(error)))
        sys.exit(2)
    except MemoryError:
        _say(Speaker()("told.memory"))
        sys.exit(2)
    except KeyboardInterrupt:
        _say(Speaker()("told.stopped"))
        sys.exit(130)
    except BrokenPipeError:
        # Who reads us has seen enough; keep Python from complaining about it at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(0)
    sys.exit(code if isinstance(code, int) else 0)


if __name__ == "__main__":
    main()
