"""`castray lesson`: read one, answer, be wrong, ask for help, be right."""

import json
from types import SimpleNamespace

import pytest

from lessons.course import lesson, lessons
from viewer.cli import main
from viewer.words import use


@pytest.fixture
def ask(tmp_path, monkeypatch, capsys):
    """`castray lesson WORDS` of a reader who begins, in this process."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.setenv("LANGUAGE", "en")

    def asked(*words):
        with pytest.raises(SystemExit) as ended:
            main(["lesson", *words])
        out, err = capsys.readouterr()
        return SimpleNamespace(returncode=ended.value.code, stdout=out, stderr=err)

    yield asked
    use("en")


def said(done):
    return " ".join(done.stdout.split())


def test_the_list_has_every_lesson_and_what_is_solved(ask):
    first = ask()
    assert first.returncode == 0, first.stderr
    for it in lessons().values():
        assert f"{it.number:02}" in first.stdout and f"0/{len(it.tasks)}" in first.stdout
    assert ask("4", "--check", "friend", "S02").returncode == 0
    assert f"1/{len(lesson(4).tasks)}" in ask("--lang", "zh").stdout
    document = json.loads(ask("--json").stdout)
    assert [entry["number"] for entry in document] == list(lessons())
    assert next(entry for entry in document if entry["number"] == 4)["solved"] == ["friend"]


@pytest.mark.parametrize("language", ["en", "zh"])
def test_a_lesson_is_readable_in_the_terminal(ask, language):
    done = ask("4", "--lang", language)
    assert done.returncode == 0, done.stderr
    assert lesson(4).words[language].title in done.stdout
    for raw in ("{{", "$", "\\", "](#", ":::"):
        assert raw not in done.stdout
    assert "θ_c = arcsin η" in done.stdout and "48.6" in done.stdout
    assert "castray view 'scene=pool&spp=8&x=130&y=96&path=0&event=2'" in done.stdout


def test_a_reader_goes_from_wrong_to_right(ask):
    early = ask("4", "--solution", "trapped")
    assert early.returncode == 2 and "try first" in early.stderr
    first = ask("4", "--check", "trapped", "2")
    assert first.returncode == 1 and "That is the first one." in first.stdout
    assert "Hint 1 of 2" in first.stdout and "--hint trapped" in first.stdout
    assert "Hint 2 of 2" in ask("4", "--hint", "trapped").stdout
    assert "no more hints" in said(ask("4", "--hint", "trapped"))
    assert "Event 7" in ask("4", "--solution", "trapped").stdout
    right = ask("4", "--check", "trapped", "7")
    assert right.returncode == 0 and "Right." in right.stdout


def test_without_a_name_the_first_open_task_is_meant(ask):
    assert ask("4", "--check", "-3").returncode == 1
    assert ask("4", "--check", "5.67", "m").returncode == 0
    assert json.loads(ask("4", "--check", "160", "96", "--json").stdout)["task"] == "rim"


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (("99",), "there is no 99"),
        (("x",), "'x' is not a whole number"),
        (("--check", "1"), "which one?"),
        (("4", "--check", "radius"), "needs your answer"),
        (("4", "--check", "radios", "2.5"), "'radios' is no task of it"),
        (("4", "--check", "rim", "a", "b"), "two whole numbers"),
        (("4", "--hint", "nothing"), "there are radius, rim"),
        (("4", "--hint", "rim", "--solution", "rim"), "one at a time"),
        (("4", "--lang", "fr"), "fr"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(ask, words, why):
    done = ask(*words)
    assert done.returncode == 2 and why in done.stderr
    assert done.stderr.count("\n") == 1 and not done.stdout


def test_json_has_the_text_filled_in_but_no_answers(ask):
    document = json.loads(ask("4", "--json").stdout)
    assert document["moments"]["start"].startswith("scene=pool&")
    tasks = [part for part in document["body"] if "task" in part]
    assert [task["task"] for task in tasks] == list(lesson(4).tasks)
    assert "{{" not in json.dumps(document)
    assert not {"answer", "wrong", "solution"} & {key for task in tasks for key in task}


def test_lost_progress_is_one_line_and_stops_nobody(ask, tmp_path):
    (tmp_path / "castray").mkdir()
    (tmp_path / "castray" / "lessons.json").write_text("broken", encoding="utf-8")
    done = ask("4", "--check", "friend", "S02")
    assert done.returncode == 0 and "Right." in done.stdout
    assert done.stderr.count("\n") == 1 and "progress is not kept" in done.stderr
    assert ask("4", "--solution", "friend").returncode == 0


def test_a_product_in_a_choice_keeps_its_sign(ask):
    assert "0.9999 * r" in ask("13").stdout
    assert "2 * sin(x / 2) ** 2" in ask("20").stdout


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (("--lesson", "99"), "there is no 99"),
        (("--lesson", "four"), "'four' is not a whole number"),
        (("pool", "--lesson", "4"), "leave out yours"),
        (("--lesson", "4", "--spp", "2"), "leave out yours"),
    ],
)
def test_the_viewer_opens_no_lesson_that_is_not_there_and_none_on_another_scene(capsys, words, why):
    with pytest.raises(SystemExit) as ended:
        main(["view", *words, "--no-browser"])
    said = capsys.readouterr()
    assert ended.value.code == 2 and why in said.err
    assert said.err.count("\n") == 1 and not said.out
