"""The table of commands."""

import importlib
import inspect
import re
import subprocess
import sys

import pytest
from suite import castray

from viewer.cli import COMMANDS, main
from viewer.words import LANGUAGES, Speaker
from viewer.words.language import ENVIRONMENT


def first_clause(text):
    return re.match(r"[^.,:?(]+", " ".join(text.split()))[0].strip()


@pytest.mark.parametrize("name", COMMANDS)
def test_what_the_table_says_of_a_command_is_what_its_own_help_begins_with(name):
    module = importlib.import_module(f"viewer.commands.{name}")
    said = Speaker("en")(f"command.{name}")
    assert first_clause(inspect.getdoc(getattr(module, name))) == first_clause(said)


def test_the_list_of_commands_waits_for_no_command():
    code = (
        "import sys\n"
        "from viewer.cli import command_line\n"
        "from viewer.words import Speaker\n"
        "command_line(Speaker())(['--help'], result_action='return_value')\n"
        "heavy = {'tracer.scene', 'tracer.engine', 'scipy', 'rich.markdown', 'lessons.zoo'}\n"
        "print(sorted(heavy & set(sys.modules)), file=sys.stderr)\n"
    )
    ran = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, encoding="utf-8", check=True, timeout=60
    )
    assert ran.stderr.splitlines()[-1] == "[]"


def test_a_command_that_is_not_there_is_named_with_one_that_is():
    ran = castray("rendr")
    assert ran.returncode == 2 and len(ran.stderr.splitlines()) == 1
    assert "rendr" in ran.stderr and "render" in ran.stderr


@pytest.mark.parametrize(
    ("words", "environment", "language"),
    [
        ((), {}, "en"),
        ((), {"LANGUAGE": "zh_CN:en"}, "zh"),
        ((), {"LANGUAGE": "fr:zh"}, "zh"),
        ((), {"LANG": "zh_CN.UTF-8"}, "zh"),
        ((), {"LANG": "fr_FR.UTF-8"}, "en"),
        ((), {"LC_ALL": "C.UTF-8", "LANG": "zh_CN.UTF-8"}, "en"),
        (("--lang", "en"), {"LANG": "zh_CN.UTF-8"}, "en"),
        (("--lang=zh",), {}, "zh"),
    ],
)
def test_the_terminal_speaks_the_language_that_is_asked_for(
    words, environment, language, monkeypatch, capsys
):
    for name in ENVIRONMENT:
        monkeypatch.delenv(name, raising=False)
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    with pytest.raises(SystemExit):
        main([*words, "--help"])
    assert Speaker(language)("command.view") in capsys.readouterr().out


def test_the_path_options_of_a_command_speak_it_too(capsys):
    for language, other in (("zh", "en"), ("en", "zh")):
        with pytest.raises(SystemExit):
            main(["--lang", language, "inspect", "--help"])
        out = capsys.readouterr().out
        assert Speaker(language)("help.path_options") in out
        assert Speaker(other)("help.path_options") not in out
        assert Speaker(language).setting("spp") in out


@pytest.mark.parametrize("words", [("--lang", "fr"), ("--lang",), ("--lang=",)])
def test_a_language_that_is_not_known_is_refused_with_those_that_are(words, capsys):
    with pytest.raises(SystemExit) as end:
        main(["bugs", *words])
    said = capsys.readouterr().err
    assert end.value.code == 2 and len(said.splitlines()) == 1
    assert all(language in said for language in LANGUAGES)
