"""What can be turned in the viewer: every knob gives a scene, and what a page asks beyond that is refused."""

import pytest

import tracer
from tracer import what_if
from tracer.scene_file.change import changed, parse, written
from viewer.link import parse as parse_link
from viewer.panels import change
from viewer.panels import what_if as what_if_panel
from viewer.session import Session
from viewer.tuning import TUNED, dials, knobs, tuned, turned
from viewer.words import LANGUAGES, Speaker

MOST = 12  # knobs tried of one scene


@pytest.fixture(scope="module")
def glass():
    """A scene with diffuse, glass, a mirror and a lamp."""
    return tracer.load("cornell_glass")


@pytest.mark.slow
@pytest.mark.parametrize("name", tracer.built_in_scenes())
def test_every_knob_can_be_turned_to_its_ends_and_back(name):
    scene = tracer.load(name)
    for knob in knobs(scene)[:MOST]:
        for value in knob.choices or (knob.low, knob.high):
            other = changed(scene, turned(scene, knob.key, value))
            now = next(k for k in knobs(other) if k.key == knob.key)
            assert now.value == (value if knob.choices else pytest.approx(value))
            assert (now.low, now.high) == (knob.low, knob.high) or now.base
        assert changed(other, {}).definition.source == scene.definition.source


def test_the_knobs_that_matter_are_there(glass):
    keys = {knob.key for knob in knobs(glass)}
    assert {"white.reflectance", "glass.int_ior", "lamp.emitter.radiance", "lamp.scale"} <= keys
    assert {"copper.alpha", "brushed.alpha_u"} <= {knob.key for knob in knobs(tracer.load("materials"))}


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("name", tracer.built_in_scenes())
def test_no_two_knobs_of_a_scene_have_one_name(name, language):
    session = Session(tracer.load(name), tracer.Settings(width=8, height=8, spp=1), None)
    session.pick(3, 3)
    labels = [knob["label"] for knob in change.show(session, Speaker(language))["knobs"]]
    assert len(set(labels)) == len(labels)


def test_a_colour_keeps_its_hue_even_through_black(glass):
    base = glass.definition.source[0]["red"]["reflectance"]
    dark = changed(glass, turned(glass, "red.reflectance", 0))
    half = changed(dark, turned(dark, "red.reflectance", max(base) / 2))
    assert half.definition.source[0]["red"]["reflectance"] == pytest.approx([c / 2 for c in base], rel=1e-4)


@pytest.mark.parametrize(
    ("key", "value"),
    [("red.reflectance", 2), ("red.reflectance", "nan"), ("red.reflectance", None), ("red.reflectance", True),
     ("red.type", 1), ("lamp", 1), (3, 1), ("mirror.material", "Kr"), ("lamp.scale", -1)],
)  # fmt: skip
def test_what_a_page_may_not_turn_is_refused(glass, key, value):
    with pytest.raises(tracer.TracerError):
        turned(glass, key, value)


@pytest.mark.parametrize(
    ("name", "value"),
    [("width", 9), ("precision", 64), ("spp", "x"), ("spp", "1e3"), ("spp", 0), ("integrator", "photon"),
     ("roulette", 3), ("bug", {}), ("max_depth", True), ("jitter", False)],
)  # fmt: skip
def test_settings_that_a_page_may_not_ask_for_are_refused(name, value):
    with pytest.raises(tracer.TracerError):
        tuned(tracer.Settings(), name, value)


def test_settings_follow_what_they_need():
    lattice = tracer.Settings(sampler="lattice", replicates=4, strategy="light")
    assert tuned(lattice, "sampler", "independent").replicates == 1
    assert tuned(lattice, "integrator", "walk").strategy == "mis"
    assert tuned(lattice, "bug", "D10").bug == "D10" and tuned(lattice, "bug", "").bug is None
    assert [dial["name"] for dial in dials(lattice)] == list(TUNED)


def test_several_bugs_that_the_command_planted_can_be_kept_in_the_list():
    (dial,) = (dial for dial in dials(tracer.Settings(bug="E01,D06")) if dial["name"] == "bug")
    assert dial["value"] == "E01,D06" and {"E01,D06", "E01", ""} <= set(dial["choices"])


def test_the_link_and_the_command_say_the_changes(glass):
    settings = tracer.Settings(width=16, height=16, spp=2, max_depth=4)
    session = Session(glass, settings, tracer.load)
    session.stand((5, 6, 1, 2))
    session.alter(
        changed(glass, parse(["glass.int_ior=1.7", "red.reflectance=0.1,0.2,0.3"])), session.settings
    )
    changes = session.scene.definition.changes
    assert parse_link(session.link.write()) == session.link and session.link.changes == changes
    assert all(f"--set {text}" in session.command.replace("'", "") for text in written(changes))
    other = Session(glass, settings, tracer.load)
    assert other.open(session.link)
    assert other.record.as_dict(other.scene) == session.record.as_dict(session.scene)
    assert other.open(parse_link("scene=cornell_glass&width=16&height=16&spp=2&max_depth=4&x=5&y=6"))
    assert other.scene.definition.changes == {}


def test_a_change_that_cannot_be_leaves_everything_as_it_is(glass):
    session = Session(glass, tracer.Settings(width=8, height=8, spp=2, max_depth=3), tracer.load)
    session.stand((1, 2, 0, 1))
    before = session.scene, session.settings, session.record, session.cursor
    with pytest.raises(tracer.TracerError):
        session.alter(glass, tuned(session.settings, "spp", 10**6))
    assert (session.scene, session.settings, session.record, session.cursor) == before


def test_the_word_what_if_stands_where_the_supposed_path_has_left_the_other(glass):
    from viewer.traces import Strokes, light_samples, vertices

    session = Session(glass, tracer.Settings(width=16, height=16, spp=2, max_depth=4), tracer.load)
    session.stand((5, 6, 0, 0))
    strokes = Strokes(3.0)
    session.suppose(what_if.parse(["0.light=0.5,0.9,0.1"]))
    there = session.supposition.path
    hit, sample = light_samples(there)[0]
    assert strokes.parting(session.path, there) == pytest.approx((hit["p"] + sample["q"]) / 2, rel=1e-5)
    session.suppose(what_if.parse(["0.bounce=10,10"]))
    there = session.supposition.path
    line = vertices(there, 3.0)
    assert strokes.parting(session.path, there) == pytest.approx((line[1] + line[2]) / 2, rel=1e-5)
    assert strokes.parting(session.path, session.path) == vertices(session.path, 3.0)[-1].tolist()


def test_what_is_supposed_is_said_in_words(glass):
    session = Session(glass, tracer.Settings(width=16, height=16, spp=2, max_depth=4), tracer.load)
    session.stand((5, 6, 0, 0))
    session.suppose(what_if.parse(["0.light=0.5,0.9,0.1"]))
    (one,) = what_if_panel.show(session, Speaker("en"))["supposed"]
    assert one == {"key": "0.light", "text": "light sample, depth 0: u₀ = 0.5, u₁ = 0.9, u₂ = 0.1"}


def test_a_depth_without_a_limit_is_said_so():
    session = Session(tracer.load("furnace"), tracer.Settings(width=4, height=4, spp=1), None)
    session.stand((0, 0, 0, 0))
    notes = {dial["key"]: dial["note"] for dial in change.show(session, Speaker("en"))["dials"]}
    assert notes["max_depth"] == "unlimited" and not any(notes[k] for k in notes.keys() - {"max_depth"})
