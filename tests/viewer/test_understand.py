"""Why a pixel is what it is: its parts add up, and each factor names the event that made it."""

from fractions import Fraction

import numpy as np
import pytest

import tracer
from lessons import zoo
from lessons.zoo import planted
from viewer.equation import origin
from viewer.understanding.waterfall import DEEP, FILM, INVALID, waterfall


def recorded(scene, x, y, **options):
    """A pixel of a small picture with every event."""
    settings = tracer.Settings(**{"width": 24, "height": 24, "spp": 6, **options})
    return tracer.inspect(tracer.load(scene), settings, x, y, steps=planted(settings))


def added(bars):
    """What the bars add up to, without rounding."""
    return [sum(bar.value[c] for bar in bars) for c in range(3)]


@pytest.mark.parametrize("scene", ["cornell_unit", "coloured_glass", "sky"])
@pytest.mark.parametrize("bug", ["", "F01", "F04", "D07"])
def test_the_bars_add_up_to_the_pixel_to_the_last_bit(scene, bug):
    for x, y in ((12, 20), (5, 15)):
        record = recorded(scene, x, y, bug=bug)
        bars = waterfall(record)
        assert added(bars) == [Fraction(float(v)) for v in record.value]
        assert added(bars[:-1]) != [Fraction(float(v)) for v in record.value] or len(bars) < 2


def test_a_bar_is_the_events_of_its_kind_and_depth_and_leads_to_the_largest():
    record = recorded("cornell_unit", 12, 20)
    for bar in waterfall(record):
        if bar.depth is None or bar.depth == DEEP:
            continue
        mine = [
            e.values["contribution"].astype(float)
            for path in record.paths
            for e in path.events
            if (e.kind.name, e.depth) == (bar.kind, bar.depth) and e.values["contribution"].any()
        ]
        assert len(mine) == bar.events
        assert [float(v) for v in bar.value] == pytest.approx(np.sum(mine, axis=0) / 6, rel=1e-12)
        path, step = bar.place
        there = record.paths[path].events[step].values["contribution"]
        weights = (0.2126, 0.7152, 0.0722)
        assert np.dot(there, weights) == pytest.approx(max(np.dot(m, weights) for m in mine))


def test_light_below_zero_and_samples_counted_otherwise_have_their_bars():
    negative = waterfall(recorded("cornell_unit", 12, 20, bug="D07"))
    lights = [bar.value for bar in negative if bar.kind == "light"]
    assert lights and all(min(value) < 0 for value in lights)
    clamped = {bar.kind: bar for bar in waterfall(recorded("cornell", 12, 3, bug="F04"))}
    assert clamped[FILM].events > 0


def test_what_is_no_number_has_a_bar_that_leads_to_it():
    record = recorded("cornell_unit", 12, 20)
    path = next(k for k, p in enumerate(record.paths) if p.radiance.any())
    event = next(e for e in record.paths[path].events if np.any(e.values.get("contribution", 0) != 0))
    event.values["contribution"] = np.full(3, np.nan, np.float32)
    record.paths[path].radiance[:] = 0.0
    bar = next(bar for bar in waterfall(record) if bar.kind == INVALID)
    assert bar.place == (path, event.step) and bar.events == 1 and not any(bar.value)


def test_a_factor_was_made_by_the_event_that_it_names():
    for bug in ("", "R01"):
        settings = zoo.of("R01").asked(width=24, height=24, spp=4, bug=bug)
        record = tracer.inspect(tracer.load("coloured_glass"), settings, 12, 14, steps=planted(settings))
        for path in record.paths:
            for event in path.events:
                field = "beta_before" if event.kind.name == "bounce" else "beta"
                if event.kind.name in ("hit", "light", "bounce"):
                    made = path.events[origin(path, event.step, field)]
                    way = event.values.get("transmittance", 1.0) if event.kind.name == "hit" else 1.0
                    assert np.allclose(event.values[field], made.values["beta"] * way)
                if event.kind.name in ("light", "bounce"):
                    assert origin(path, event.step, "f") == origin(path, event.step, "cos") < event.step
                    assert path.events[origin(path, event.step, "f")].kind.name == "hit"
