"""Tests over many events: their chances are chances, and each finds what it is for."""

import numpy as np
import pytest
from mutants import traced, with_column
from suite import suite_seed

from tracer.doctor import examine
from tracer.doctor.statistics import cells


@pytest.mark.statistical
@pytest.mark.parametrize("groups", [2, 60])
def test_means_of_groups_have_no_smaller_chances_than_they_should(groups):
    rng = np.random.default_rng(suite_seed())
    chances = np.array([cells.means(rng.random(500), rng.integers(0, groups, 500)) for _ in range(2000)])
    for low in (0.5, 0.1, 0.01):
        assert np.mean(chances < low) <= low


def test_one_number_for_the_group_and_for_the_place_in_it_is_seen_though_all_together_are_uniform():
    u = (np.arange(400) + 0.5) / 400
    assert cells.means(u, (u < 0.5).astype(int)) < 1e-20
    assert cells.uniform(u) > 0.5


@pytest.mark.statistical
def test_right_points_on_many_lamps_break_no_law():
    (verdict,) = [v for v in examine(traced("lamps", seed=suite_seed())).rules if v.rule.id == "lamp-points"]
    assert verdict.state == "clean" and verdict.checked > 3


def strata(film, width):
    """A quarter of the pixel for each of its four samples."""
    which = np.arange(film.shape[1]) % 4
    return np.floor(film) + 0.5 * (np.stack((which % 2, which // 2)) + film % 1.0)


def film(trace, change=None, logged=False):
    """The verdict of the law on the places of a trace's samples, moved by change(film, width) and told by the
    rays alone, or logged."""
    place = trace.paths["film"].astype(np.float64)
    moved = place if change is None else change(place, trace.settings.width)
    _, d = trace.scene.camera.rays(moved, trace.settings.width, trace.settings.height, np.float64)
    told = with_column(with_column(trace, "camera.d", d), "camera.film", moved if logged else None)
    (verdict,) = [v for v in examine(told, only={"film"}).rules if v.rule.id == "film"]
    return verdict


RIGHT_PLACES = {
    "even": None,
    "in the middle": lambda film, width: np.floor(film) + 0.5,
    "in a corner": lambda film, width: np.floor(film),
    "in strata": strata,
    "over two pixels, as a tent": lambda film, width: np.floor(film) + 0.5 + _tent(film % 1.0),
    "a pattern": lambda film, width: (
        np.floor(film) + np.array([0.0, 0.5, 0.25])[np.arange(film.shape[1]) % 3]
    ),
}
WRONG_PLACES = {
    "one pixel too narrow": lambda film, width: film * (width / (width - 1)),
    "the left half": lambda film, width: np.floor(film) + np.array([[0.5], [1.0]]) * (film % 1.0),
    "a quarter of a pixel aside": lambda film, width: film + 0.25,
}


def _tent(u):
    return np.where(u < 0.5, np.sqrt(2.0 * u) - 1.0, 1.0 - np.sqrt(np.maximum(2.0 - 2.0 * u, 0.0)))


@pytest.mark.statistical
@pytest.mark.parametrize("logged", [False, True])
@pytest.mark.parametrize("places", RIGHT_PLACES)
def test_samples_may_lie_in_their_pixels_in_any_even_way(places, logged):
    trace = traced("room", width=32, height=32, seed=suite_seed())
    assert film(trace, RIGHT_PLACES[places], logged).state != "fired"


@pytest.mark.statistical
@pytest.mark.parametrize("places", WRONG_PLACES)
def test_a_picture_that_is_stretched_or_moved_within_its_pixels_is_seen_from_rays_alone(places):
    trace = traced("room", width=32, height=32, seed=suite_seed())
    assert film(trace, WRONG_PLACES[places]).state == "fired"
