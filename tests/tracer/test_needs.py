"""What a scene does not need is not done: counted, and said by --explain."""

import json
from dataclasses import replace

import numpy as np
import pytest
from cases import loaded, slow_but
from suite import castray

import tracer
from tracer import Settings
from tracer.engine.needs import needs
from tracer.integrator.steps import RIGHT

SMALL = Settings(width=16, height=16, spp=4, max_depth=6)
SCENES = tuple(name for name in tracer.built_in_scenes())


class Counted:
    """The right steps, with what they were asked noted."""

    def __init__(self):
        self.lanes = dict.fromkeys(("visibility", "light_point", "bounce", "roulette"), 0)

    @property
    def steps(self):
        return replace(RIGHT, **{name: self._noting(name) for name in self.lanes})

    def _noting(self, name):
        step = getattr(RIGHT, name)

        def noted(*arguments):
            answer = step(*arguments)
            self.lanes[name] += np.shape(arguments[-1])[-1] if name != "visibility" else answer.size
            return answer

        return noted


def counted(scene, settings=SMALL):
    """How many lanes each step was asked for, and the picture."""
    scene = loaded(scene) if isinstance(scene, str) else scene
    counts = Counted()
    picture = tracer.render(scene, settings, steps=counts.steps)
    return counts.lanes, picture


def switch(scene, settings, name):
    scene = loaded(scene) if isinstance(scene, str) else scene
    return next(need for need in needs(scene, settings.at_size_of(scene)) if need.name == name)


def box(**changes):
    """The unit box with some of its objects changed, None to leave one out."""
    description = json.loads(json.dumps(loaded("cornell_unit").definition.source[0])) | changes
    return tracer.load_dict({name: table for name, table in description.items() if table is not None})


def without_lamp(**more):
    return box(lamp=None, **more)


def test_without_lights_there_are_no_light_samples_and_no_shadow_rays():
    lanes, picture = counted(without_lamp())
    assert lanes["visibility"] == lanes["light_point"] == 0 and not picture.rgb.any()
    assert not switch(without_lamp(), SMALL, "light samples").on
    assert counted("cornell_unit")[0]["visibility"] > 0


def test_where_all_is_mirror_or_glass_no_light_is_sampled():
    glass = {"type": "dielectric"}
    lamp = {"type": "sphere", "radius": 0.2, "bsdf": glass, "emitter": {"type": "area", "radiance": 1.0}}
    ball = {"type": "sphere", "center": [0.0, 0.0, -2.0], "bsdf": glass}
    scene = tracer.load_dict(
        {"sensor": loaded("cornell_unit").definition.source[0]["sensor"], "a": lamp, "b": ball}
    )
    assert counted(scene)[0]["light_point"] == 0
    assert switch(scene, SMALL, "light samples").why.startswith("every material")


@pytest.mark.parametrize("integrator", ["path", "direct", "walk"])
def test_at_depth_1_nothing_is_sampled_after_the_first_hit(integrator):
    lanes, _ = counted("cornell_unit", replace(SMALL, max_depth=1, integrator=integrator))
    assert set(lanes.values()) == {0}


def test_where_lights_are_sampled_the_last_vertex_chooses_no_direction():
    """Its bounce could only find emission that light samples count."""
    settings = replace(SMALL, max_depth=2, integrator="direct")
    lanes, direct = counted("cornell_unit", settings)
    assert lanes["bounce"] == 0 < lanes["visibility"]
    assert counted("cornell_unit", replace(settings, integrator="path"))[0]["bounce"] > 0
    # A replaced step may count that emission: then the bounce is made.
    counts = Counted()
    steps = replace(counts.steps, emission_weight=lambda *arguments: RIGHT.emission_weight(*arguments))
    assert (tracer.render(loaded("cornell_unit"), settings, steps=steps).rgb == direct.rgb).all()
    assert counts.lanes["bounce"] > 0


def test_a_black_wall_ends_the_path():
    black = {"type": "diffuse", "reflectance": 0.0}
    lanes, _ = counted(box(white=black, green=black, red=black))
    assert set(lanes.values()) == {0}


def test_an_object_of_index_1_changes_nothing_and_costs_nothing():
    pane = {"type": "sphere", "radius": 0.3, "bsdf": {"type": "dielectric", "int_ior": 1.0, "ext_ior": 1.0}}
    (lanes, picture), (with_pane, other) = counted("cornell_unit"), counted(box(pane=pane))
    assert with_pane == lanes and other.rays == picture.rays
    assert other.rgb.tobytes() == picture.rgb.tobytes()


def test_walls_and_the_only_lamp_are_not_asked_for_shadows():
    scene = loaded("cornell_unit")
    assert len(scene.arrangement.closest) == 4 and len(scene.arrangement.blocking) == 3
    assert scene.arrangement.walls_never_block
    assert "floor" in switch(scene, SMALL, "shadow rays").why


@pytest.mark.parametrize("scene", slow_but(SCENES, "cornell_unit", "many_lights", "sky", "furnace"))
@pytest.mark.parametrize("precision", [32, 64])
def test_what_is_left_out_of_shadow_tests_never_blocks(scene, precision):
    """Against the nearest hit of all shapes; an answer in a thousand may differ by where the rays end."""
    settings = replace(SMALL, precision=precision, integrator="path")
    asked = differ = 0

    def visibility(scene, hit, light):
        nonlocal asked, differ
        seen = RIGHT.visibility(scene, hit, light)
        t, met = scene.intersect(scene.spawn(hit, light.wi), light.wi, hit.primitive)
        clear = (t >= light.distance * 0.999) | (met == light.primitive)
        asked += seen.size
        differ += int(np.count_nonzero(seen != clear))
        return seen

    tracer.render(loaded(scene), settings, steps=replace(RIGHT, visibility=visibility))
    assert differ <= 1e-3 * asked


@pytest.mark.parametrize("scene", SCENES)
def test_every_need_is_told_once(scene):
    told = [need.name for need in needs(loaded(scene), SMALL.at_size_of(loaded(scene)))]
    assert len(set(told)) == len(told)


@pytest.mark.slow
def test_explain_says_what_is_on_and_off_and_why(tmp_path):
    words = ("render", "cornell_unit", "--size", 8, 8, "--spp", 1, "-o", tmp_path / "box.png", "--explain")
    done = castray(*words)
    assert done.returncode == 0 and "walls met as one box" in done.stdout and "off" in done.stdout
    told = json.loads(castray(*words, "--json").stdout)["explain"]
    assert {"name", "on", "why"} == told[0].keys()
    assert all(need["why"] for need in told)
    assert {need["name"] for need in told if need["on"]} >= {"light samples", "shadow rays", "MIS weights"}
