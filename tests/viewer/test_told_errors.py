"""What is refused is said in Chinese, too: by the command line, of files, and wherever an error is raised."""

import ast
import re
from string import Formatter

import pytest
from suite import ROOT

from viewer.cli import main
from viewer.words import Speaker, table


def names(words):
    """The {names} that a text has filled in."""
    return {name for _, name, _, _ in Formatter().parse(words) if name is not None}


# Errors that users meet often, as the command line gives them.
OFTEN = (
    "render nowhere", "render cornell_unit --spp 0", "render cornell_unit --spp 1.5",
    "render cornell_unit --integrator photon", "render cornell_unit --roulette 2",
    "render cornell_unit --roulette off", "render cornell_unit --bug no-such-bug",
    "render cornell_unit --size 65535 65535", "render cornell_unit --integrator walk --strategy light",
    "render cornell_unit --sampler independent --replicates 2",
    "render cornell_unit --sampler lattice --replicates 3 --spp 4", "inspect cornell_unit --pixel 999 0",
    "inspect cornell_unit --pixel 0 0 --sample 99", "render cornell_unit --bounces 3", "rendr", "render",
    "inspect cornell_unit", "render cornell_unit --jitter=5", "render a b", "diff no.exr no.exr",
    "render cornell_unit -o no/such/folder.npy", "view scene=nowhere", "view scene=furnace&bounces=3",
    "view http://127.0.0.1/", "render cornell_unit --set white",
    "render cornell_unit --set whit.reflectance=1",
    "render cornell_unit --set white.colour=1", "inspect cornell_unit --pixel 0 0 --sample 0 --what-if x",
    "inspect cornell_unit --pixel 0 0 --sample 0 --what-if 1.bounce=3",
    "inspect cornell_unit --pixel 0 0 --sample 0 --what-if 999.bounce=3,4",
    "inspect cornell_unit --pixel 0 0 --event 3", "inspect cornell_unit --pixel 0 0 --sample 0 --event 99",
    "inspect cornell_unit --pixel 0 0 --sample 0 --event 0",
    "render cornel", "render nowhere.toml", "render cornell_unit --bug e01", "render cornell_unit --ssp 4",
    "inspect cornell_unit --pixel 3", "view --lesson 3 --spp 4", "view cornell --scene cornell", "lesson one",
    "lesson 4 --check", "lesson 4 --hint nothing", "lesson --check 3", "bugs E1", "doctor nowhere.jsonl",
    "doctor no.png", "log nowhere.jsonl", "query nowhere x", "twin cornell_unit", "bsdf glas",
    "bsdf diffuse -o x.jpg", "bsdf diffuse 3", "export furnace -o no", "check no.py --seconds 0",
    "render cornell_unit --until-error 0", "render cornell_unit -o x.jpeg2", "render furnace --workers 0",
    "render furnace --adaptive x --until-error 1", "render furnace --record-level events", "bench",
    "diff no.exr", "render furnace --engine x", "render furnace --spp four", "render furnace --accel x",
)  # fmt: skip
BROKEN = (
    "[sensor]\ntype = 'x'",
    "[sensor]\ntype = 'perspectiv'",
    "[sensor",
    "[sensor]\ntype = 'perspective'\n[box]\ntype = 'cube'\nbsdf = 'whit'",
    "sensor = 3",
    "[light]",
)


def refused(words, capsys):
    """The one line that the command says before it gives up."""
    with pytest.raises(SystemExit) as end:
        main(words)
    assert end.value.code == 2
    return capsys.readouterr().err.strip()


@pytest.mark.parametrize("words", OFTEN)
def test_errors_that_users_see_often_are_told_in_chinese(words, capsys):
    english = refused(words.split(), capsys)
    chinese = refused(["--lang", "zh", *words.split()], capsys)
    assert "\n" not in chinese and chinese != english
    assert re.search(r"[\u4e00-\u9fff]", chinese)


@pytest.mark.parametrize("text", BROKEN)
def test_errors_in_scene_files_are_told_in_chinese(text, tmp_path, capsys):
    file = tmp_path / "room.toml"
    file.write_text(text, encoding="utf-8")
    said = refused(["--lang", "zh", "render", str(file)], capsys)
    assert re.search(r"[\u4e00-\u9fff]", said) and str(file) in said


ERRORS = [(key, words) for key, words in table("en").items() if key.startswith("error.")]


@pytest.mark.parametrize(("key", "words"), ERRORS, ids=[key for key, _ in ERRORS])
def test_no_error_is_taken_for_a_more_general_one(key, words):
    """Of all patterns that fit an error the first says it: those that are general come last."""
    said = words.format(**{name: f"<{name}>" for name in names(words)})
    chinese = table("zh")[key].format(**{name: f"<{name}>" for name in names(words)})
    if "which" not in names(words) and "kind" not in names(words):
        assert Speaker("zh").error(said) == chinese


HINTS = ("hint", "close", "near", "why", "_why")  # filled in, or nothing
NAMED = {"RIGHT": "'right'", "wanted": "a number"}
FILLED = [{"hint": hint, "known": known} for hint in ("", "7") for known in ("known here: 7", "there are 7")]
# Who writes lessons or Python reads English.
WRITERS = ("lessons/lesson.py", "lessons/run.py", "viewer/notebook.py", "tracer/testing/health.py")


def raised(node, told):
    """The words that a TracerError is raised with, with a hint or without; what is filled in is a number or a
    quoted text. None where they are another error's."""
    if isinstance(node, ast.Constant):
        return node.value
    if not isinstance(node, ast.JoinedStr):
        return None
    said = "".join(p.value if isinstance(p, ast.Constant) else filled(p, told) for p in node.values)
    return said if re.search(r"[a-z]+ [a-z]+", said) else None


def filled(part, told):
    """What stands for a value in the words of an error."""
    name = getattr(getattr(part.value, "func", part.value), "id", "")
    own = told["hint"] if name in HINTS else (NAMED | told).get(name)
    return own if own is not None else "'X'" if part.conversion == 114 else "7"


def refusals():
    """Where each TracerError is raised that a user may meet, and with which words, with a hint or without."""
    for folder in ("tracer", "lessons", "viewer"):
        for file in sorted((ROOT / folder).rglob("*.py")):
            for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
                if isinstance(node, ast.Call) and getattr(node.func, "id", "") in ("TracerError", "Lost"):
                    said = [raised(node.args[0], told) for told in FILLED]
                    if (
                        said[-1]
                        and file.relative_to(ROOT).as_posix() not in WRITERS
                        and "needs its steps" not in said[-1]
                    ):
                        yield f"{file.name}: {said[-1]}", said


def test_whatever_is_refused_is_told_in_chinese():
    told = dict(refusals())
    assert len(told) > 300
    say = Speaker("zh")
    assert [where for where, said in told.items() if not any(chinese(say.error(s)) for s in said if s)] == []


def chinese(said):
    return re.search(r"[\u4e00-\u9fff]", said)


def test_an_error_that_is_not_in_the_table_keeps_its_own_words():
    assert Speaker("zh").error("something quite new") == "something quite new"
    assert Speaker("en").error("sensor: is missing") == "sensor: is missing"
