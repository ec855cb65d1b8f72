"""The events of coloured glass multiply out, and scenes without it carry nothing of it."""

from collections import deque
from functools import partial

import numpy as np
import pytest
from cases import INTEGRATORS, loaded
from glass import ROUGH, filled, lit_inside

import tracer
from lessons import zoo
from tracer import Settings
from tracer.engine import waves
from tracer.events import HIT, LIGHT
from tracer.integrator.wave import Wave
from viewer.caption import light_outcome, why_dead
from viewer.words import Speaker


@pytest.mark.parametrize("precision", [32, 64])
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_throughput_on_arrival_is_that_before_times_the_share_left(suite_seed, integrator, precision):
    """To the last bit, and exp(-sigma_t t) of the way within rounding."""
    scene = loaded("coloured_glass")
    settings = Settings(
        width=20, height=14, spp=6, seed=suite_seed, integrator=integrator, precision=precision
    )
    inside, sampled = 0, 0
    for x in (4, 9, 16, 17):
        for path in tracer.inspect(scene, settings, x, 8).paths:
            beta = np.ones(3, settings.dtype)
            for event in path.events:
                v = event.values
                if event.kind is HIT:
                    assert v["beta"].tobytes() == (beta * v["transmittance"]).tobytes()
                if event.kind in (HIT, LIGHT):
                    assert ((v["transmittance"] >= 0) & (v["transmittance"] <= 1)).all()
                    inside += event.kind is HIT and v["transmittance"].max() < 1
                    sampled += event.kind is LIGHT and v["transmittance"].max() < 1
                beta = v.get("beta", beta)
    assert inside > 20 and (sampled > 10 or integrator == "walk")


def test_a_light_sample_through_black_glass_asks_for_no_shadow_and_says_why(suite_seed):
    """Nothing could arrive: whether the lamp is seen does not matter."""
    scene = lit_inside(ROUGH)
    black = {**scene.definition.source[0]["glass"], "interior": filled(1e6)}
    scene = tracer.load_dict({**scene.definition.source[0], "glass": black})
    settings = Settings(spp=8, width=4, height=4, max_depth=3, seed=suite_seed)
    paths = tracer.inspect(scene, settings, 1, 2).paths
    inside = [
        (path, e.values)
        for path in paths
        for e in path.events
        if e.kind is LIGHT and e.values["f"].any() and e.values["cos_light"] > 0
    ]
    assert inside
    for path, v in inside:
        assert not v["visible"] and not v["transmittance"].any() and light_outcome(v) == "absorbed"
        assert "absorbed on the way" in why_dead(path, scene, Speaker("en"))


def never(scene, medium, distance):
    raise AssertionError("asked where nothing is filled")


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("scene", ["cornell_unit", "cornell_glass"])
def test_a_scene_without_coloured_glass_pays_nothing(suite_seed, monkeypatch, scene, integrator):
    """No column, no field, no question."""
    seen = []
    taken = Wave.meet

    def meet(wave, scene, paths, strategy):
        seen.append(paths)
        return taken(wave, scene, paths, strategy)

    monkeypatch.setattr(Wave, "meet", meet)
    settings = Settings(width=8, height=8, spp=2, seed=suite_seed, integrator=integrator)
    scene = loaded(scene).at(settings)
    pixel = np.arange(64)
    wave = Wave(pixel % 8, pixel // 8, np.zeros(64), settings, zoo.changed(transmittance=never))
    events = list(waves.events(scene, settings, wave))
    assert scene.media is None and seen
    assert all(paths.medium is None and paths.transmittance is None for paths in seen)
    assert not any("transmittance" in event.columns for event in events)


def test_a_scene_with_coloured_glass_asks_once_a_way(suite_seed):
    """The test above can fail."""
    asked = []
    steps = zoo.changed(transmittance=partial(_counted, asked))
    scene, settings = loaded("coloured_glass"), Settings(width=8, height=8, seed=suite_seed, max_depth=3)
    wave = Wave(np.arange(8), np.full(8, 5), np.zeros(8), settings, steps)
    deque(waves.events(scene, settings, wave), maxlen=0)
    assert 3 <= len(asked) <= 6


def _counted(asked, scene, medium, distance):
    asked.append(medium.size)
    return zoo.RIGHT.transmittance(scene, medium, distance)
