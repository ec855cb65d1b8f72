"""Where the reader stands, and where each move leads."""

import pytest

from viewer.cursor import MOVES, Cursor

START = Cursor(3, 4, lengths=(5, 2, 7))


def walked(cursor, *moves):
    for move in moves:
        cursor = getattr(cursor, move)()
    return cursor.path, cursor.event


def test_forward_stops_at_the_last_event():
    assert walked(START, *["next"] * 9) == (0, 4)


def test_back_stops_at_the_first_event():
    assert walked(START, "next", "previous", "previous") == (0, 0)


def test_first_and_last_go_to_the_ends_of_the_path():
    assert walked(START, "last") == (0, 4)
    assert walked(START, "last", "first") == (0, 0)


def test_another_path_begins_at_its_first_event():
    assert walked(START, "last", "down") == (1, 0)
    assert walked(START, "down", "down", "last", "up") == (1, 0)


def test_beyond_the_last_path_nothing_changes():
    assert walked(START, "down", "down", "next", "down") == (2, 1)
    assert walked(START, "next", "up") == (0, 1)


def test_forward_and_back_over_a_path_return_to_the_start():
    steps = START.lengths[0] - 1
    assert walked(START, *["next"] * steps, *["previous"] * steps) == (0, 0)


@pytest.mark.parametrize("move", MOVES)
def test_a_move_changes_nothing_but_path_and_event(move):
    moved = getattr(START, move)()
    assert (moved.x, moved.y, moved.lengths) == (START.x, START.y, START.lengths)


@pytest.mark.parametrize("place", [{"path": 3}, {"path": -1}, {"event": 5}, {"event": -1}])
def test_a_place_that_does_not_exist_is_refused(place):
    with pytest.raises(IndexError):
        Cursor(3, 4, (5, 2, 7), **place)
