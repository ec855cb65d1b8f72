"""Why a pixel is what it is: its parts add up, and each factor names the event that made it."""

import json
import re
from fractions import Fraction

import numpy as np
import pytest
from cases import slow_but
from suite import castray

import tracer
from lessons import zoo
from lessons.zoo import planted
from viewer.caption import caption, light_outcome, why_dead
from viewer.equation import origin
from viewer.numerals import luminance
from viewer.panels import vertex as vertex_panel
from viewer.session import Session
from viewer.understanding import lens, microscope
from viewer.understanding.draws import DRAWS, OFF
from viewer.understanding.lens_words import judged
from viewer.understanding.places import places
from viewer.understanding.vertex import Vertex
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


@pytest.mark.parametrize("language", LANGUAGES)
def test_what_is_no_number_is_called_nan_and_not_light_that_the_surface_does_not_reflect(language):
    say, scene = Speaker(language), tracer.load("materials")
    settings, seen = tracer.Settings(width=48, height=32, spp=4, bug="S08"), 0
    for x, y in ((0, 0), (5, 20), (10, 0)):
        record = tracer.inspect(scene, settings, x, y, steps=planted(settings))
        for path in record.paths:
            for event in path.events:
                if event.kind.name == "light" and np.isnan(event.values["contribution"]).any():
                    seen += 1
                    assert light_outcome(event.values) == "undefined" and "NaN" in caption(event, scene, say)
        for sentence in (*(r.sentence(say) for r in why(record, scene)), why_dead(path, scene, say)):
            assert not re.search(r"\bnan\b", sentence)
    assert seen >= 3


def test_a_path_that_meets_no_surface_is_not_asked_to_go_on_to_one():
    session = Session(tracer.load("sky"), tracer.Settings(width=16, height=16, spp=2), None)
    for y, key in ((1, "lens.never"), (14, "lens.not_yet")):  # the sky, the ground
        session.pick(8, y)
        session.cursor = session.cursor.first()
        assert vertex_panel.show(session, Speaker("en"))["none"] == Speaker("en")(key)


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


SEEN = {  # bug: the reason that gives it away, and the kind of event that it leads to
    "D01": ("light.phantom", "light"),
    "D03": ("redone.through", "light"),
    "D06": ("unfit.f", "light"),
    "D07": ("light.negative", "light"),
    "D11": ("unfit.result", "light"),
    "D14": ("redone.density", "light"),
    "D20": ("unfit.direction", "light"),
    "B01": ("unfit.pdf", "bounce"),
    "B02": ("unfit.result", "bounce"),
    "B09": ("redone.direction", "bounce"),
    "E01": ("met.certain", "hit"),
    "E02": ("met.lost", "hit"),
    "E06": ("light.back_lit", "light"),
    "F01": ("film", "end"),
    "G03": ("redone.hit", "hit"),
    "M01": ("redone.weight", "light"),
    "N03": ("redone.normal", "hit"),
    "R01": ("unfit.result", "roulette"),
    "R03": ("redone.fate", "roulette"),
    "S06": ("redone.share", "bounce"),
}


def strange(scene, settings):
    """Reasons that no right tracer has, of some pixels, with the records."""
    for x, y in ((12, 3), (8, 10), (16, 10), (8, 20), (16, 22), (3, 9), (18, 15), (12, 16)):
        record = tracer.inspect(scene, settings, x, y, steps=planted(settings))
        yield from ((reason, record) for reason in why(record, scene) if reason.strange)


@pytest.mark.parametrize("bug", slow_but(SEEN, *list(SEEN)[::3]))
def test_a_mistake_is_a_reason_that_leads_to_its_event(bug):
    scene = tracer.load(zoo.of(bug).scene)
    for reason, record in strange(scene, zoo.of(bug).asked(width=24, height=24, spp=8, bug=bug)):
        path, step = reason.place
        if (reason.key, record.paths[path].events[step].kind.name) == SEEN[bug]:
            return
    pytest.fail("nothing gives it away")


@pytest.mark.slow
@pytest.mark.parametrize("scene", ["cornell", "materials", "smooth_ball", "coloured_glass"])
def test_a_right_tracer_has_no_strange_reason(scene):
    for settings in (
        zoo.of("D01").asked(width=24, height=24, spp=4),
        tracer.Settings(width=24, height=24, spp=4),
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


@pytest.mark.slow
def test_the_command_says_why_in_words_and_in_json():
    words = ("inspect", "cornell_unit", "--pixel", 12, 16, "--size", 24, 24, "--spp", 6, "--why")
    document = json.loads(castray(*words, "--json").stdout)
    record = recorded("cornell_unit", 12, 16)
    expected = [r.as_dict(Speaker("en")) for r in why(record, tracer.load("cornell_unit"))]
    assert document["why"] == expected and document["made_of"] == []
    text = castray(*words).stdout
    for reason in expected:
        assert reason["sentence"] in text


def lens_of(scene, x, y, kind, **options):
    """The Lens over the first event of a kind, and the event."""
    record = recorded(scene, x, y, **options)
    path, event = next((k, e) for k, p in enumerate(record.paths) for e in p.events if e.kind.name == kind)
    ready = tracer.load(scene).at(record.settings)
    return lens.over(ready, planted(record.settings), record, path, event.step), event, record


@pytest.mark.parametrize(("scene", "place"), [("cornell_unit", (12, 20)), ("materials", (7, 15))])
def test_the_lens_shows_the_angles_that_were_recorded(scene, place):
    seen, event, record = lens_of(scene, *place, "bounce")
    hit = next(e.values for p in record.paths for e in p.events if e.kind.name == "hit")
    assert seen.vectors["wi"][2] == pytest.approx(event.values["cos"], rel=1e-4)
    assert seen.vectors["wo"][2] == pytest.approx(hit["cos_wo"], rel=1e-4)
    assert seen.vectors["wo"][0] <= 0 and abs(seen.vectors["wo"][1]) < 1e-6
    own = [one for one in seen.tried if one.place == (0, event.step)]
    assert np.allclose(own[0].shown, seen.vectors["wi"]) and own[0].kind == "bounce"


def test_what_is_drawn_over_the_vertex_is_what_the_event_recorded():
    seen, event, _ = lens_of("cornell_unit", 12, 20, "bounce")
    angles, f, p = seen.plane
    assert p[np.argmin(np.abs(angles))] == pytest.approx(1 / np.pi, rel=1e-3)
    ready = tracer.load("cornell_unit").at(tracer.Settings())
    vertex = Vertex(ready, next(q.hit for q in places(lens_of("cornell_unit", 12, 20, "bounce")[2]) if q.hit))
    f, p = vertex.asked(vertex.shown(event.values["wi"].reshape(3, 1)))
    assert p[0] == pytest.approx(event.values["pdf"], rel=1e-4)
    assert f[0] == pytest.approx(luminance(event.values["f"]) * event.values["cos"], rel=1e-3)


@pytest.mark.parametrize(
    "scene", slow_but(("cornell_unit", "materials", "cornell_glass", "smooth_ball"), "cornell_unit")
)
def test_bounces_of_a_right_tracer_go_where_the_density_says(scene):
    """2048 fixed draws; each count is judged at 5 standard errors, once in a million for a right one."""
    for x, y in ((7, 15), (12, 18), (15, 14)):
        seen, _, _ = lens_of(scene, x, y, "hit")
        assert sum(count.observed for count in seen.counts) == DRAWS
        known = [count.expected for count in seen.counts]
        if None not in known:
            assert sum(known) == pytest.approx(1.0, abs=0.01)
            assert abs(seen.worst.off) < OFF


@pytest.mark.parametrize("bug", ["B08", "B09", "W01"])
def test_bounces_that_do_not_go_there_are_seen(bug):
    """The test above can fail: wrong directions are tens of standard errors off."""
    asked = zoo.of(bug).asked(width=24, height=24, spp=4, bug=bug).as_dict()
    seen, _, _ = lens_of(zoo.of(bug).scene, 15, 4, "hit", **asked)
    assert abs(seen.worst.off) > OFF
    assert judged(seen, Speaker("en"))["verdict"].startswith("✗")


def test_a_dirac_lobe_that_is_missed_or_has_no_direction_is_seen():
    """S02 goes on where all is reflected, in a direction that is no number."""
    record = recorded("pool", 175, 96, width=192, height=192, spp=8, bug="S02")
    seen = lens.over(tracer.load("pool").at(record.settings), planted(record.settings), record, 1, 2)
    counts = {c.where: (c.observed, c.expected) for c in seen.counts if isinstance(c.where, str)}
    assert counts == {"reflection": (0, 1.0), "nowhere": (DRAWS, 0.0)}
    assert judged(seen, Speaker("en"))["judged"] == "warning"


def test_the_terms_behind_f_are_the_event_s_and_head_on_those_of_the_normal():
    seen, event, _ = lens_of("materials", 20, 40, "bounce", width=64, height=64)
    for name in ("F", "D", "G1", "G2"):
        here, head_on = seen.terms[name]
        assert np.array_equal(here, event.values[name])
        assert head_on.size == np.size(here)
    assert seen.terms["G1"][1] == seen.terms["G2"][1] == pytest.approx(1.0)
    assert lens_of("cornell_unit", 12, 20, "bounce")[0].terms == {}


@pytest.mark.parametrize("precision", [32, 64])
@pytest.mark.parametrize("scene", slow_but(("cornell", "materials", "smooth_ball"), "cornell"))
def test_a_ray_starts_off_its_own_surface_by_more_than_its_point_may_be_off_it(scene, precision):
    for x, y in ((7, 15), (12, 18)):
        record = recorded(scene, x, y, spp=4, precision=precision)
        ready = tracer.load(scene).at(record.settings)
        for k, path in enumerate(record.paths):
            for event in path.events:
                there = microscope.ends(ready, record, k, event.step)
                assert (there is not None) == (event.kind.name in ("light", "bounce"))
                if there:
                    start = there.start
                    assert abs(start.point) <= start.offset + 2 * start.ulp
                    assert start.start >= start.offset - abs(start.point) - 2 * start.ulp
                    assert start.start < 64 * start.ulp + start.aside


def test_a_lamp_and_the_point_on_it_are_as_far_away_but_for_some_ulps():
    record = recorded("cornell", 12, 8)
    ready, met = tracer.load("cornell").at(record.settings), 0
    for k, path in enumerate(record.paths):
        for event in path.events:
            there = microscope.ends(ready, record, k, event.step)
            if there and there.aim and there.visible:
                assert abs(there.aim.ulps) < 16 and there.blocker is None
                met += 1
            elif there and there.blocker:
                assert there.blocker_distance < there.aim.distance
    assert met


def test_another_tracer_is_held_to_what_it_recorded_only():
    """It has random numbers of its own, and what it left out is no number."""
    record, scene = recorded("cornell_unit", 12, 20), tracer.load("cornell_unit")
    for path in record.paths:
        for event in path.events:
            if "u" in event.values and event.kind.name != "roulette":
                event.values["u"] = np.full(3, np.nan, np.float32)
            if event.kind.name == "bounce":
                event.values["pdf"] = np.float32(np.nan)
    assert {r.key for r in why(record, scene) if r.strange} >= {"redone.direction", "unfit.pdf"}
    assert not [r.key for r in why(record, scene, own=False) if r.strange]
    seen = lens.over(scene.at(record.settings), None, record, 0, 2)
    assert seen.counts == () and judged(seen, Speaker("en"))["judged"] == "dim"
