"""Progress is kept from one command to the next, and its loss stops nobody."""

import json

import pytest

from lessons.progress import Done, Progress, home


def test_progress_is_there_again(tmp_path):
    Progress(tmp_path / "new" / "folder").note(4, "radius", Done(2, 1, True))
    again = Progress(tmp_path / "new" / "folder")
    assert again.of(4, "radius") == Done(2, 1, True)
    assert again.of(4, "rim") == Done()
    assert again.solved(4) == {"radius"} and again.solved(5) == set()
    assert [file.name for file in (tmp_path / "new" / "folder").iterdir()] == ["lessons.json"]


@pytest.mark.parametrize(
    "text", ["", "{", "[]", '{"04": 3}', '{"04": {"radius": {}}}', '{"x": {"radius": 1}}', "7"]
)
def test_a_broken_file_is_told_and_left_alone(tmp_path, text):
    (tmp_path / "lessons.json").write_text(text, encoding="utf-8")
    with pytest.warns(UserWarning, match="it is not what castray wrote"):
        progress = Progress(tmp_path)
    progress.note(4, "radius", Done(1, 0, True))
    assert progress.solved(4) == {"radius"} and not progress.kept
    assert (tmp_path / "lessons.json").read_text(encoding="utf-8") == text


def test_two_who_learn_at_the_same_time_lose_nothing(tmp_path):
    viewer, terminal = Progress(tmp_path), Progress(tmp_path)
    terminal.note(4, "rim", Done(1, 0, True))
    viewer.note(4, "radius", Done(1, 0, True))
    assert Progress(tmp_path).solved(4) == viewer.solved(4) == {"radius", "rim"}


def test_a_folder_that_cannot_be_written_is_told_once(tmp_path):
    (tmp_path / "file").write_text("in the way", encoding="utf-8")
    progress = Progress(tmp_path / "file" / "deeper")
    if progress.kept:
        with pytest.warns(UserWarning, match="progress is not kept"):
            progress.note(4, "radius", Done(1, 0, True))
    progress.note(4, "rim", Done(1, 0, True))
    assert progress.solved(4) == {"radius", "rim"} or progress.solved(4) == {"rim"}


def test_the_folder_is_the_one_that_the_user_names(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "状态"))
    assert home() == tmp_path / "状态" / "castray"
    Progress().note(1, "a", Done(1, 0, False))
    file = tmp_path / "状态" / "castray" / "lessons.json"
    assert json.loads(file.read_text(encoding="utf-8")) == {
        "01": {"a": {"tries": 1, "hints": 0, "solved": False}}
    }
