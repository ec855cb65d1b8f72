"""Why a pixel is what it is: its parts add up, and each factor names the event that made it."""

import json
from fractions import Fraction

import numpy as np
import pytest
from suite import said

import tracer
from lessons import zoo
from lessons.zoo import planted
from viewer.equation import origin
from viewer.understanding.waterfall import DEEP, FILM, INVALID, waterfall
from viewer.understanding.why import why
from viewer.words import LANGUAGES, Speaker


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


SEEN = {  # bug: the reason that gives it away
    "D01": "light.phantom",
    "D04": "light.phantom",
    "D06": "unfit.f",
    "D07": "light.negative",
    "D11": "unfit.result",
    "B01": "unfit.pdf",
    "B02": "unfit.result",
    "E01": "met.certain",
    "E02": "met.lost",
    "R01": "unfit.result",
}


def strange(scene, settings):
    """Reasons that no right tracer has, of some pixels, with the records."""
    for x, y in ((12, 3), (8, 10), (16, 10), (8, 20), (16, 22)):
        record = tracer.inspect(scene, settings, x, y, steps=planted(settings))
        yield from ((reason, record) for reason in why(record, scene) if reason.strange)


@pytest.mark.parametrize("bug", SEEN)
def test_a_mistake_is_a_reason_that_leads_to_its_event(bug):
    scene, kinds = tracer.load(zoo.of(bug).scene), set()
    for reason, record in strange(scene, zoo.of(bug).asked(width=24, height=24, spp=16, bug=bug)):
        if reason.key == SEEN[bug]:
            path, step = reason.place
            kinds.add(record.paths[path].events[step].kind.name)
    expected = {"D": {"light"}, "B": {"bounce"}, "E": {"hit"}, "R": {"roulette"}}
    assert kinds == expected[bug[0]]


@pytest.mark.parametrize("scene", ["cornell", "materials", "smooth_ball", "coloured_glass"])
def test_a_right_tracer_has_no_strange_reason(scene):
    for settings in (
        zoo.of("D01").asked(width=24, height=24, spp=8),
        tracer.Settings(width=24, height=24, spp=8),
    ):
        assert not list(strange(tracer.load(scene), settings))


def test_the_reasons_of_a_black_pixel_are_ranked_and_account_for_all_light_samples():
    record = recorded("cornell_unit", 12, 16)
    first, *others = why(record, tracer.load("cornell_unit"))
    assert first.key == "black" and first.of == 6
    assert [r.weight for r in others] == sorted((r.weight for r in others), reverse=True)
    samples = sum(e.kind.name == "light" for p in record.paths for e in p.events)
    assert sum(r.count for r in others if r.key.startswith("light.")) == samples
    assert sum(r.count for r in others if r.key.startswith("end.")) == 6


@pytest.mark.parametrize(
    ("scene", "place", "options", "key"),
    [
        ("cornell_unit", (12, 20), {"integrator": "walk", "max_depth": 3}, "unsampled.settings"),
        ("glass_slab", (11, 11), {"max_depth": 2}, "unsampled.mirror"),
        ("cornell_unit", (12, 20), {"max_depth": 1}, "end.max_depth"),
        ("cornell_unit", (12, 20), {"roulette": "0.1"}, "end.roulette"),
        ("cornell_unit", (12, 3), {}, "light.behind"),
    ],
)
def test_why_light_is_missing_is_said(scene, place, options, key):
    for x, y in (place, (place[0] + 1, place[1]), (place[0], place[1] + 1)):
        keys = [r.key for r in why(recorded(scene, x, y, **options), tracer.load(scene))]
        if key in keys:
            return
    pytest.fail(f"{key} is not among {keys}")


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_reason_is_a_sentence_of_its_language(language):
    say = Speaker(language)
    for scene in ("cornell_glass", "sky", "materials"):
        record = recorded(scene, 10, 14, spp=4)
        for reason in why(record, tracer.load(scene)):
            said = reason.sentence(say)
            assert said.endswith((".", "。")) and "{" not in said
            assert reason.as_dict(say)["sentence"] == said


def test_the_command_says_why_in_words_and_in_json():
    words = ("inspect", "cornell_unit", "--pixel", 12, 16, "--size", 24, 24, "--spp", 6, "--why")
    document = json.loads(said(*words, "--json"))
    record = recorded("cornell_unit", 12, 16)
    expected = [r.as_dict(Speaker("en")) for r in why(record, tracer.load("cornell_unit"))]
    assert document["why"] == expected and document["made_of"] == []
    text = said(*words)
    for reason in expected:
        assert reason["sentence"] in text
