"""The table of commands."""

import importlib
import inspect
import re
import subprocess
import sys

import pytest
from suite import castray

from viewer.cli import COMMANDS


def first_clause(text):
    return re.match(r"[^.,:?(]+", " ".join(text.split()))[0].strip()


@pytest.mark.parametrize("name", COMMANDS)
def test_what_the_table_says_of_a_command_is_what_its_own_help_begins_with(name):
    module = importlib.import_module(f"viewer.commands.{name}")
    assert first_clause(inspect.getdoc(getattr(module, name))) == first_clause(COMMANDS[name])


def test_the_list_of_commands_waits_for_no_command():
    code = (
        "import sys\n"
        "from viewer.cli import app\n"
        "app(['--help'], result_action='return_value')\n"
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
