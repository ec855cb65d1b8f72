"""A recording that is asked many times answers as one that is asked once."""

import threading
import time

import pytest

import tracer
from tracer.settings import TracerError
from tracer.trace.asker import Asker, ask
from tracer.trace.query import answer

SETTINGS = tracer.Settings(width=6, height=5, spp=3, max_depth=5)
LONG = "SELECT count(*) FROM events a, events b, events c, events d, events e"


@pytest.fixture(scope="module")
def box(tmp_path_factory):
    place = tmp_path_factory.mktemp("asked") / "box"
    tracer.record(tracer.load("cornell_unit"), SETTINGS, place, "events")
    return place


@pytest.fixture
def asker(box):
    asker = Asker(box)
    yield asker
    asker.close()


@pytest.mark.slow
def test_one_process_answers_question_after_question_as_query_does(asker, box):
    for text in ("SELECT 1", "depth >= 1"):
        assert asker.ask(text) == answer(asker.place, text, 20)
        child = asker._child.pid
    for bad in ("nothing = 1", "SELECT * FROM read_csv('x')", " "):
        said = []
        for who in (asker.ask, lambda text: ask(box, text)):
            with pytest.raises(TracerError) as error:
                who(bad)
            said.append(str(error.value))
        assert said[0] == said[1]
    assert asker.columns("SELECT count(*) AS n FROM paths")["n"].tolist() == [6 * 5 * 3]
    assert asker._child.pid == child


@pytest.mark.slow
def test_a_question_that_takes_too_long_is_ended_and_the_next_one_answered(asker):
    with pytest.raises(TracerError, match="longer than 0.3 seconds"):
        asker.ask(LONG, seconds=0.3)
    assert asker.ask("depth >= 1")["paths"] > 0


@pytest.mark.slow
def test_closing_ends_the_question_that_is_asked(asker):
    asker.ask("depth >= 1")
    said = []

    def wait():
        with pytest.raises(TracerError) as error:
            asker.ask(LONG)
        said.append(str(error.value))

    thread = threading.Thread(target=wait)
    thread.start()
    while not asker._lock.locked():
        time.sleep(0.01)
    asker.close()
    thread.join(timeout=20)
    assert said and "without an answer" in said[0]
    with pytest.raises(TracerError, match="not asked any more"):
        asker.ask("depth >= 1")
