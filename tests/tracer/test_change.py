"""A scene with some words said differently is the scene that says so."""

import copy

import numpy as np
import pytest
from suite import castray

import tracer
from tracer.scene_file.change import changed, parse, plain, written

SMALL = tracer.Settings(width=12, height=12, spp=2, max_depth=4)


def picture(scene):
    """Its pixels, bit for bit."""
    return tracer.render(scene, SMALL).rgb.tobytes()


@pytest.fixture(scope="module")
def box():
    """The unit box."""
    return tracer.load("cornell_unit")


def said(scene, name, word, value):
    """The scene made anew from a description in which one word was replaced by hand."""
    description, folder = copy.deepcopy(scene.definition.source)
    table = description[name]
    for inner in word.split(".")[:-1]:
        table = table[inner]
    table[word.split(".")[-1]] = value
    return tracer.load_dict(description, scene.name, folder)


@pytest.mark.parametrize(
    ("text", "name", "word", "value"),
    [
        ("white.reflectance=0.5", "white", "reflectance", 0.5),
        ("red.reflectance=0.1,0.2,0.3", "red", "reflectance", [0.1, 0.2, 0.3]),
        ("lamp.emitter.radiance=[1, 2, 3]", "lamp", "emitter.radiance", [1, 2, 3]),
        ("sensor.fov=60", "sensor", "fov", 60),
    ],
)
def test_a_changed_scene_is_the_scene_that_says_so_bit_for_bit(box, text, name, word, value):
    assert picture(changed(box, parse([text]))) == picture(said(box, name, word, value)) != picture(box)


def test_a_shape_is_scaled_about_its_own_origin(box):
    larger = changed(box, parse(["lamp.scale=2"]))
    corners = [scene.shapes[0].triangles()[0] for scene in (box, larger)]
    middle = corners[0].mean(axis=0)
    assert np.allclose(corners[1] - middle, 2.0 * (corners[0] - middle))


def test_changes_are_of_the_scene_as_it_was_loaded(box):
    once = changed(box, parse(["lamp.scale=2", "white.reflectance=0.5"]))
    again = changed(once, parse(["lamp.scale=2"]))
    assert picture(again) == picture(changed(box, parse(["lamp.scale=2"])))
    assert again.definition.changes == {"lamp.scale": 2}
    assert picture(changed(again, {})) == picture(box)
    assert changed(box, {}) is box


@pytest.mark.parametrize(
    "text", ["white.reflectance=0.5", "a.b=[0.1,2,3e-05]", "mirror.material=Au", "a.b.c=true", "a.b=-1"]
)
def test_what_is_written_is_read_as_the_same(text):
    changes = parse([text])
    assert parse(written(changes)) == changes
    assert written(changes) == (text,)


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("white", ("white", "OBJECT.WORD=VALUE")),
        ("white=3", ("white=3",)),
        ("white.reflectance=", ("white.reflectance",)),
        ("whit.reflectance=0.5", ("whit", "'white'")),
        ("white.colour=0.5", ("white.colour", "reflectance")),
        ("white.reflectance=7", ("white.reflectance", "from 0 to 1")),
        ("white.reflectance=bright", ("white.reflectance", "bright")),
        ("white.reflectance=[1,2", ("white.reflectance", "[1,2")),
        ("lamp.nothing.x=1", ("lamp.nothing.x", "emitter")),
        ("lamp.scale=0", ("lamp.scale", "above 0")),
        ("lamp.scale=nan", ("lamp.scale", "finite")),
        ("lamp.emitter.radiance=inf", ("lamp.emitter.radiance", "finite")),
        ("white.reflectance=" + "9" * 500, ("white.reflectance",)),
    ],
)
def test_a_change_that_will_not_do_is_told_in_one_line(box, text, parts):
    with pytest.raises(tracer.TracerError) as error:
        changed(box, parse([text]))
    said = str(error.value)
    assert "\n" not in said and said.startswith("set: ") and all(part in said for part in parts)


@pytest.mark.parametrize(
    "text", ["wood.filename=secret.png", "a.b.filename=x", "a.b={type='ref'}", "a.b=[[1]]"]
)
def test_a_link_may_change_numbers_and_words_and_name_no_files(text):
    with pytest.raises(tracer.TracerError, match="numbers and words only"):
        plain(parse([text]))


def test_a_scene_made_in_python_has_no_words(box):
    bare = type(box)(box.definition._replace(source=None))
    with pytest.raises(tracer.TracerError, match="made in Python"):
        changed(bare, {"a.b": 1})


def test_a_recording_of_a_changed_scene_is_of_the_changed_scene(box, tmp_path):
    from tracer.trace import folder
    from tracer.trace.stored_scene import restore

    darker = changed(box, parse(["white.reflectance=0.25"]))
    tracer.record(darker, SMALL, tmp_path / "kept")
    place = folder.whole(tmp_path / "kept")
    assert picture(restore(place.path, "kept")) == picture(darker)


@pytest.mark.slow
@pytest.mark.parametrize(
    "words",
    [
        ("render", "cornell_unit"),
        ("inspect", "cornell_unit", "--pixel", "0", "0"),
        ("view", "cornell_unit", "--no-browser"),
        ("doctor", "cornell_unit"),
        ("twin", "cornell_unit", "--bug", "D10"),
        ("bench", "cornell_unit"),
    ],
    ids=lambda words: words[0],
)
def test_every_command_with_path_options_takes_changes(words, tmp_path):
    done = castray(*words, "--size", "8", "8", "--set", "nowhere.word=1", cwd=tmp_path)
    assert done.returncode == 2 and len(done.stderr.splitlines()) == 1
    assert "nowhere" in done.stderr and "white" in done.stderr
