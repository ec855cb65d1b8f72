"""The picture in the making: what its painter tells, and when."""

import asyncio
from types import SimpleNamespace

import pytest
from talking import alone

import tracer
from viewer import painting
from viewer.painting import Painting, Post
from viewer.session import Session


class State(SimpleNamespace):
    """The page's state, where it is only kept."""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass


def a_painting(**settings):
    """The Painting of a small picture, and its session."""
    scene = tracer.load("cornell_unit")
    session = Session(scene, tracer.Settings(width=8, height=8, **settings), tracer.load)
    window = SimpleNamespace(session=session, state=State(rgb=b"", progress=""), say=lambda *_, **__: "")
    return Painting(window), session


async def complete(session):
    while session.spp_done != session.settings.spp:
        await asyncio.sleep(0.01)


async def samples_here(before):
    """Samples of a picture that is there at once; before: whether another was made before it."""
    work, session = a_painting(spp=4)
    if before:
        work.begin()
        await complete(session)
        session.spp_done = 0
    work.begin()
    work.wait()
    here = session.spp_done
    await complete(session)
    return here


def test_a_picture_that_comes_soon_comes_with_the_words(monkeypatch):
    monkeypatch.setattr(painting, "TOGETHER", 60.0)
    assert alone(samples_here(before=True)) == 1


@pytest.mark.parametrize("limit", [0.0, 60.0], ids=["it takes longer", "nobody knows how long it takes"])
def test_words_do_not_wait_for_a_picture_that_may_be_long_in_coming(monkeypatch, limit):
    monkeypatch.setattr(painting, "TOGETHER", limit)
    assert alone(samples_here(before=not limit)) == 0


def test_what_was_waited_for_is_done_once_and_in_order():
    async def told():
        done, post = [], Post(asyncio.get_running_loop())
        send, other = post.sender(done.append), post.sender(done.append, awaited=False)
        other(1)
        send(2)
        post.wait(60.0)
        now = list(done)
        await asyncio.sleep(0)
        send(3)
        await asyncio.sleep(0)
        return now, done

    assert alone(told()) == ([1, 2], [1, 2, 3])


def test_what_a_painter_tells_that_was_replaced_is_not_done():
    async def told():
        done, post = [], Post(asyncio.get_running_loop())
        send = post.sender(done.append)
        send(1)
        post.refuse()
        await asyncio.sleep(0)
        post.wait(0.0)
        return done

    assert alone(told()) == []
