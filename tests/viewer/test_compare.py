"""Compare: the twin of a pixel, the maps of two pictures, and what may be compared with."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from suite import castray

import tracer
from lessons.zoo import planted
from tracer.testing import compare
from viewer import app
from viewer.comparing import first, maps, rival
from viewer.comparing.comparer import beside, desk_of
from viewer.comparing.twins import PixelTwin
from viewer.pictured import serve_picture
from viewer.recorded import serve_recording
from viewer.session import Session

SETTINGS = tracer.Settings(width=16, height=16, spp=4, max_depth=4)


@pytest.fixture(scope="module")
def scene():
    return tracer.load("cornell_unit")


@pytest.fixture(scope="module")
def pictures(scene):
    """The right picture and the one with D10."""
    wrong = replace(SETTINGS, bug="D10")
    return tracer.render(scene, SETTINGS), tracer.render(scene, wrong, steps=planted(wrong))


@pytest.fixture(scope="module")
def pixel(pictures):
    """x, y of the pixel that differs most."""
    return compare(*pictures).errors.worst[:2]


@pytest.fixture
def session(scene, pixel):
    """A session that compares with D10, at a pixel."""
    made = Session(scene, SETTINGS, None)
    made.against = "D10"
    made.stand((*pixel, 0, 0))
    return made


def values_at(event):
    return {name: np.asarray(value).tobytes() for name, value in event.values.items()}


def test_a_path_and_its_twin_are_the_same_up_to_where_they_part(session):
    parted = 0
    for k in range(len(session.record.paths)):
        session.cursor = session.cursor.on(k)
        there = beside(session)
        mine, its = session.path.events, there.path.events
        step = min(len(mine), len(its)) if there.parting is None else there.parting.steps[0]
        assert all(values_at(a) == values_at(b) for a, b in zip(mine[:step], its[:step], strict=True))
        if there.parting is not None:
            parted += 1
            assert mine[step].kind.name == "light"
            assert not np.array_equal(mine[step].values["contribution"], its[step].values["contribution"])
    assert parted > 0


def test_the_twins_pixel_is_that_of_the_other_tracers_picture(session, pictures, pixel):
    twin = PixelTwin(session.scene, SETTINGS, rival.of_scene("D10", session.scene, SETTINGS), *pixel)
    for record, picture in zip((session.record, twin.record), pictures, strict=True):
        assert record.value.tobytes() == picture.rgb[pixel[1], pixel[0]].tobytes()


def test_other_random_numbers_have_no_twins(session):
    other = rival.Rival("other", session.scene, replace(SETTINGS, seed=1))
    with pytest.raises(tracer.TracerError, match="seed is 0"):
        PixelTwin(session.scene, session.settings, other, 0, 0)


def test_the_map_of_the_difference_is_a_less_b_of_the_channel_furthest_off(pictures):
    a, b = pictures
    overlay = maps.view("difference", a, b, compare(a, b))
    apart = a.rgb.astype(float) - b.rgb
    assert np.abs(overlay.values) == pytest.approx(np.abs(apart).max(axis=2), rel=1e-6)
    assert overlay.low == -overlay.high and overlay.high > 0


def test_the_map_of_the_ratio_is_a_divided_by_b(pictures):
    a, b = pictures
    overlay = maps.view("ratio", a, b, compare(a, b))
    y, x = np.unravel_index(np.nanargmax(np.abs(np.log(overlay.values))), overlay.values.shape)
    with np.errstate(all="ignore"):
        ratios = a.rgb[y, x].astype(float) / b.rgb[y, x]
    assert np.isclose(ratios, overlay.values[y, x], rtol=1e-5).any()
    assert overlay.log and overlay.low * overlay.high == pytest.approx(1.0)


def test_the_map_of_z_is_the_z_test_s(pictures):
    a, b = pictures
    verdict = compare(a, b)
    overlay = maps.view("z", a, b, verdict)
    there = np.isfinite(overlay.values)
    assert np.abs(overlay.values[there]) == pytest.approx(
        np.nanmax(np.abs(verdict.z.z), axis=2)[there], rel=1e-6
    )
    assert overlay.high == maps.SURE


def test_a_picture_without_variance_has_no_z(pictures, tmp_path):
    tracer.write(pictures[1], tmp_path / "mine.png")
    there = rival.of_file(str(tmp_path / "mine.png"))
    assert maps.possible(compare(pictures[0], there.picture)) == ("difference", "ratio")
    assert not there.traced


def test_a_recording_is_compared_as_it_was_recorded_and_its_paths_traced_again(
    scene, pictures, pixel, tmp_path
):
    wrong = replace(SETTINGS, bug="D10")
    tracer.record(scene, wrong, tmp_path / "box", "paths", steps=planted(wrong))
    there = rival.of_file(str(tmp_path / "box"))
    assert there.picture.rgb.tobytes() == pictures[1].rgb.tobytes()
    assert PixelTwin(scene, SETTINGS, there, *pixel).found.differing > 0


def test_a_picture_of_another_size_sets_the_size_or_is_refused(pictures, tmp_path):
    tracer.write(pictures[1], tmp_path / "mine.npy")
    there = rival.of_file(str(tmp_path / "mine.npy"))
    fitted = rival.fitted(tracer.Settings(), there)
    assert (fitted.width, fitted.height) == (16, 16)
    with pytest.raises(tracer.TracerError, match="give --size 16 16"):
        rival.fitted(tracer.Settings(width=8, height=8), there)


def test_a_log_has_no_picture_to_compare_with():
    with pytest.raises(tracer.TracerError, match="castray twin compares logs"):
        rival.of_file("mine.jsonl")


@pytest.fixture
def opened(monkeypatch):
    """The sessions that the viewer would have shown."""
    sessions = []
    monkeypatch.setattr(app, "_run", lambda session, *_: sessions.append(session))
    return sessions


def test_two_recordings_are_opened_side_by_side(scene, tmp_path, opened):
    for name, bug in (("right", None), ("wrong", "D10")):
        asked = replace(SETTINGS, bug=bug)
        tracer.record(scene, asked, tmp_path / name, "paths", steps=planted(asked))
    serve_recording(str(tmp_path / "right"), against=str(tmp_path / "wrong"))
    assert opened[0].recording is not None
    assert desk_of(opened[0]).rival.settings.bug == "D10" and beside(opened[0]) is not None


def test_a_picture_is_opened_beside_what_it_is_of(pictures, opened, tmp_path):
    file = tmp_path / "wrong.exr"
    tracer.write(pictures[1], file, scene="cornell_unit")
    serve_picture(str(file))
    serve_picture(str(file), against="right")
    assert [session.against for session in opened] == [str(file), "right"]
    assert all(session.settings == pictures[1].settings for session in opened)
    assert desk_of(opened[0]).picture.rgb.tobytes() == pictures[1].rgb.tobytes()


def test_a_picture_that_does_not_say_what_it_is_of_is_refused(pictures, tmp_path):
    tracer.write(pictures[1], tmp_path / "mine.png")
    with pytest.raises(tracer.TracerError, match="castray view SCENE --compare"):
        serve_picture(str(tmp_path / "mine.png"))


@pytest.mark.slow
def test_what_cannot_be_compared_with_is_one_clear_line():
    ran = castray("view", "cornell_unit", "--no-browser", "--compare", "Z99", timeout=60)
    assert ran.returncode == 2 and ran.stdout == ""
    assert len(ran.stderr.splitlines()) == 1 and "Z99" in ran.stderr


def edge_and_wall(noise=0.0):
    """Two pictures from the same random numbers: in b a wall is darker, and along a lamp's edge a sample of a
    pixel in three misses the lamp."""
    chance = np.random.default_rng(1)
    a = np.full((24, 24, 3), 0.2) + noise * chance.standard_normal((24, 24, 1))
    b = a.copy()
    b[12:, 4:10] -= 0.05
    b[2, ::3] += 3.0
    b[3, 1::3] -= 3.0
    return SimpleNamespace(rgb=a), SimpleNamespace(rgb=b)


@pytest.mark.parametrize("noise", [0.0, 0.3])
def test_the_pixel_to_look_at_first_differs_as_its_surroundings_do(noise):
    a, b = edge_and_wall(noise)
    verdict = compare(a, b)
    assert verdict.errors.worst[1] in (2, 3)  # the largest difference is one sample on the lamp's edge
    x, y = first.pixel(a, b, verdict, same_numbers=True)
    assert 4 <= x < 10 and 12 <= y


def test_where_only_single_pixels_differ_the_largest_difference_is_looked_at():
    a, b = edge_and_wall()
    b.rgb[12:] = a.rgb[12:]
    verdict = compare(a, b)
    assert first.pixel(a, b, verdict, same_numbers=True) == verdict.errors.worst[:2]
    tiny = [SimpleNamespace(rgb=np.full((1, 2, 3), value)) for value in (0.1, 0.4)]
    assert first.pixel(*tiny, compare(*tiny), same_numbers=True) in ((0, 0), (1, 0))


def test_of_pictures_of_other_numbers_the_surroundings_that_are_furthest_off_are_looked_at(scene):
    other = replace(SETTINGS, seed=1, bug="D10", spp=16)
    a, b = tracer.render(scene, replace(SETTINGS, spp=16)), tracer.render(scene, other, steps=planted(other))
    verdict = compare(a, b)
    assert verdict.z.p_bias < verdict.z.alpha
    assert first.pixel(a, b, verdict, same_numbers=False) == verdict.z.centre[:2]
