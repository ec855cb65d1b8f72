"""Random scenes and settings give a picture or one clear refusal: no other exception, no warning, no hang.

`CASTRAY_FUZZ=5000` asks for that many examples of each test; Hypothesis shrinks a failure and prints it.
"""

import warnings
from dataclasses import fields

import numpy as np
import pytest
from fuzzing import FUZZ, edited, edits, numbers, picture_or_refusal, spoiled, values
from hypothesis import given
from hypothesis import strategies as st

import tracer
from tracer import SceneWarning, Settings, TracerError

pytestmark = pytest.mark.slow


@FUZZ
@given(spoiled())
def test_a_spoiled_dict(room):
    picture_or_refusal(lambda: tracer.load_dict(room))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("fuzz")


AS_TOML = """
[sensor]
type = "perspective"
fov = 50
to_world = [{ look_at = { origin = [0, 0, 3], target = [0, 0, 0], up = [0, 1, 0] } }]
film = { width = 5, height = 4 }
[lamp]
type = "rectangle"
to_world = [{ scale = [1, 2, 1] }, { rotate = [1, 0, 0], angle = 90 }, { translate = [0, 1.5, 0] }]
emitter = { type = "area", radiance = [4, 5, 6] }
[ball]
type = "sphere"
bsdf = { type = "dielectric", int_ior = "water" }
"""


@FUZZ
@given(edits)
def test_an_edited_toml_file(folder, changes):
    (folder / "edited.toml").write_bytes(edited(AS_TOML, changes))
    picture_or_refusal(lambda: tracer.load(folder / "edited.toml"))


@FUZZ
@given(spoiled())
def test_what_is_a_scene_goes_to_mitsuba_and_back(folder, room):
    """Whatever can be rendered can be exported, and comes back the same to the last bit."""
    try:
        scene = tracer.load_dict(room)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SceneWarning)
            tracer.export(scene, folder / "out.xml")
    except TracerError:
        return
    back, wanted = tracer.load(folder / "out.xml"), Settings(spp=1, max_depth=3, width=5, height=4)
    seen = [outcome(s, wanted) for s in (scene, back)]
    assert np.array_equal(*seen) if isinstance(seen[0], np.ndarray) else seen[0] == seen[1]


def outcome(scene, wanted):
    """The picture, or the refusal of what the precision cannot hold."""
    try:
        return tracer.render(scene, wanted).rgb
    except TracerError as refused:
        return str(refused)


@st.composite
def any_settings(draw):
    """Some settings, right and wrong ones."""
    chosen = {}
    for f in fields(Settings):
        if f.name in ("width", "height", "spp", "max_depth"):
            continue
        if draw(st.integers(0, 3)) == 0:
            good = st.sampled_from(f.metadata["choices"] or [0, 1, 7, 0.5, "0.5", "off", "auto", True])
            chosen[f.name] = draw(st.one_of(good, good, good, values))
    return {
        **chosen,
        "max_depth": draw(st.one_of(st.integers(-2, 9), numbers)),
        "spp": draw(st.integers(0, 3)),
    }


@FUZZ
@given(spoiled(1), any_settings())
def test_any_settings(room, chosen):
    try:
        wanted = Settings(width=5, height=4, **chosen)
    except TracerError:
        return
    if wanted.max_depth > 9 or wanted.roulette != "auto" and wanted.max_depth < 0:
        return  # right, but as long as one asks for
    picture_or_refusal(lambda: tracer.load_dict(room), wanted)
