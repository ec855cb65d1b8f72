"""A link names a moment, holds no key, and is read as strictly as any other word from outside."""

import pytest

from tracer.settings import Settings, TracerError
from viewer.link import Link, is_link, parse

MOMENT = Link(
    "cornell_unit",
    Settings(spp=4, max_depth=5, jitter=False, heuristic="balance", precision=64),
    (9, 7, 2, 3),
)


def test_a_link_comes_back_as_it_was_written():
    assert parse(MOMENT.write()) == MOMENT


def test_a_link_keeps_who_looks_for_triangles():
    link = Link("smooth_ball", Settings(accel="embree"), (1, 2, 0, 0))
    assert "accel=embree" in link.write() and parse(link.write()) == link


def test_a_link_keeps_the_tracer_that_is_compared_with():
    link = Link("furnace", Settings(), (1, 2, 0, 0), compare="D01")
    assert "compare=D01" in link.write() and parse(link.write()) == link


def test_a_whole_address_is_a_link():
    assert parse("http://127.0.0.1:8123/#" + MOMENT.write()) == MOMENT
    assert is_link("http://127.0.0.1:8123/#" + MOMENT.write())


def test_a_link_may_name_no_pixel():
    assert parse("scene=furnace") == Link("furnace", Settings())


def test_path_and_event_may_be_left_out():
    assert parse("scene=furnace&x=1&y=2").place == (1, 2, 0, 0)


def test_a_scene_file_is_no_link():
    assert not is_link("scenes/cornell.toml")
    assert not is_link("cornell_unit")


@pytest.mark.parametrize(
    "text",
    [
        "",
        "cornell_unit",
        "x=1&y=2",
        "scene=",
        "scene=a&scene=b",
        "scene=a&key=b",
        "scene=a&x=1",
        "scene=a&x=1&y=-2",
        "scene=a&x=1&y=2&path=1.5",
        "scene=a&x=1&y=2&event=²",
        "scene=a&spp=many",
        "scene=a&spp=0",
        "scene=a&jitter=1",
        "scene=a&integrator=bdpt",
        "scene=a&compare=/etc/passwd",
        "scene=a&x=99999999999999999999&y=1",
        "scene=" + "a" * 5000,
        "scene=a&" + "&".join(f"x{k}=1" for k in range(99)),
    ],
)
def test_a_bad_link_is_one_clear_line(text):
    with pytest.raises(TracerError) as refused:
        parse(text)
    assert "\n" not in str(refused.value) and len(str(refused.value)) < 400


def test_a_link_carries_the_planted_bug():
    asked = Link("cornell", Settings(bug="E01"), (3, 4, 0, 1))
    assert parse("http://127.0.0.1:1/#" + asked.write()) == asked
