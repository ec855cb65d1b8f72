"""What random scenes, files and commands are made of, and what may come of them."""

import copy
import math
import os
import re
import warnings
from datetime import timedelta

import numpy as np
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st

import tracer
from tracer import SceneWarning, Settings, TracerError
from tracer.scene_file.load import BUILT_IN

EXAMPLES = int(os.environ.get("CASTRAY_FUZZ", "150"))
FUZZ = settings(
    max_examples=EXAMPLES,
    deadline=timedelta(seconds=20),  # a scene that hangs fails here, or at the suite's own limit
    suppress_health_check=list(HealthCheck),
    derandomize="CASTRAY_FUZZ" not in os.environ,
    database=None,
)
COMPASS = str(BUILT_IN / "pictures" / "compass.png")
ROOM = {
    "sensor": {
        "type": "thinlens",
        "fov": 50.0,
        "aperture_radius": 0.01,
        "focus_distance": 3.0,
        "to_world": [{"look_at": {"origin": [0, 0, 3], "target": [0, 0, 0], "up": [0, 1, 0]}}],
        "film": {"width": 5, "height": 4},
    },
    "glass": {"type": "dielectric", "int_ior": 1.5},
    "metal": {"type": "roughconductor", "material": "Au", "alpha_u": 0.2, "alpha_v": 0.1},
    "lamp": {
        "type": "rectangle",
        "to_world": [{"scale": [1, 2, 1]}, {"rotate": [1, 0, 0], "angle": 90}, {"translate": [0, 1.5, 0]}],
        "emitter": {"type": "area", "radiance": [4, 5, 6]},
    },
    "bulb": {"type": "point", "position": [1, 1, 1], "intensity": 2.0},
    "sun": {"type": "directional", "direction": [0, -1, 0.1], "irradiance": [1, 1, 1]},
    "sky": {"type": "constant", "radiance": 0.3},
    "ball": {
        "type": "sphere",
        "center": [0.3, 0, 0],
        "radius": 0.5,
        "bsdf": "glass",
        "interior": {"type": "homogeneous", "albedo": 0, "sigma_t": [0.1, 1.0, 5.0], "scale": 1.5},
    },
    "box": {"type": "cube", "to_world": [{"scale": 0.4}, {"translate": [-0.6, 0, 0]}], "bsdf": "metal"},
    "board": {"type": "checkerboard", "color0": [0.9, 0.1, 0.2], "to_uv": [{"scale": [4, 3, 1]}]},
    "floor": {
        "type": "rectangle",
        "to_world": [{"rotate": [1, 0, 0], "angle": -90}, {"translate": [0, -1, 0]}],
        "bsdf": {
            "type": "twosided",
            "bsdf": {"type": "diffuse", "reflectance": {"type": "ref", "id": "board"}},
        },
    },
    "wall": {
        "type": "rectangle",
        "to_world": [{"translate": [0, 0, -1]}],
        "bsdf": {
            "type": "plastic",
            "diffuse_reflectance": {
                "type": "bitmap",
                "filename": COMPASS,
                "filter_type": "nearest",
                "wrap_mode": "mirror",
                "raw": True,
                "to_uv": [{"rotate": [0, 0, 1], "angle": 30}, {"translate": [0.2, 0.1, 0]}],
            },
        },
    },
}
WORDS = sorted(
    {word for table in ROOM.values() for word in table}
    | {
        "area",
        "conductor",
        "diffuse",
        "rectangle",
        "sphere",
        "cube",
        "obj",
        "ref",
        "id",
        "value",
        "rgb",
        "alpha",
    }
    | {"plastic", "roughdielectric", "roughplastic", "thindielectric", "perspective", "matrix", "k", "eta"}
    | {"interior", "exterior"}
)

numbers = st.one_of(
    st.floats(),
    st.integers(-(10**400), 10**400),
    st.sampled_from(
        [0, -0.0, 1, -1, 1e-30, 1e-8, 1e8, 1e30, 1e300, 5e-324, math.inf, -math.inf, math.nan, 180, 65535]
    ),
    st.floats(-10, 10),
)
plain = st.one_of(
    numbers,
    st.booleans(),
    st.none(),
    st.text(max_size=8),
    st.sampled_from(WORDS),
    st.lists(numbers, max_size=4),
)
values = st.recursive(
    plain,
    lambda inner: st.one_of(
        st.lists(inner, max_size=4),
        st.dictionaries(st.one_of(st.sampled_from(WORDS), st.text(max_size=4)), inner, max_size=4),
    ),
    max_leaves=8,
)


def likely(value):
    """Values of the same sort, which will more often than not make a scene."""
    if isinstance(value, str):
        return st.sampled_from(WORDS)
    sizes = st.sampled_from([1e-12, 1e-6, 1e-3, 0.5, 1.0, 2.0, 1e3, 1e6, 1e12])
    return st.one_of(st.floats(-2, 2), st.floats(0, 1), st.integers(1, 9), sizes, sizes.map(lambda x: -x))


def places(table, path=()):
    """Paths to every value in nested tables and lists."""
    items = table.items() if isinstance(table, dict) else enumerate(table)
    for key, value in items:
        yield (*path, key)
        if isinstance(value, (dict, list)):
            yield from places(value, (*path, key))


PLACES = list(places(ROOM))


@st.composite
def spoiled(draw, most=3):
    """ROOM with some values put in the place of others, taken out, or added."""
    room = copy.deepcopy(ROOM)
    for _ in range(draw(st.integers(1, most))):
        path = draw(st.sampled_from(PLACES))
        table = room
        try:
            for key in path[:-1]:
                table = table[key]
            do = draw(st.sampled_from(["nudge", "nudge", "nudge", "put", "number", "take", "add"]))
            if do == "nudge" and isinstance(table[path[-1]], (dict, list)):
                continue
            if do == "take":
                del table[path[-1]]
            elif do == "add" and isinstance(table, dict):
                table[draw(st.sampled_from(WORDS))] = draw(values)
            else:
                table[path[-1]] = draw({"nudge": likely(table[path[-1]]), "number": numbers}.get(do, values))
        except (KeyError, IndexError, TypeError):
            continue  # an earlier change took the place away
    return room


def picture_or_refusal(load, wanted=None):
    """Load and render; a refusal has to be one line that says something."""
    wanted = wanted or Settings(spp=1, max_depth=3, width=5, height=4)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            warnings.simplefilter("ignore", SceneWarning)
            picture = tracer.render(load(), wanted)
    except TracerError as refused:
        message = str(refused)
        assert message and len(message) < 2000, message
        return
    assert np.isfinite(picture.rgb).all() and (picture.rgb >= 0).all()


QUOTED = re.compile(r'(?:=|\[|, )\s*"?([^"\[\]{}=,<>]+)')
odd = st.one_of(numbers.map(str), st.sampled_from(WORDS), st.text(max_size=6))
edits = st.lists(
    st.tuples(st.sampled_from(["quote", "quote", "line", "twice", "cut", "char"]), st.floats(0, 1), odd),
    min_size=1,
    max_size=3,
)


def edited(text, changes):
    """Text with a value replaced, a line taken out or doubled, the end cut off, or a character changed."""
    for do, where, new in changes:
        lines, at = text.split("\n"), round(where * max(len(text) - 1, 0))
        row = text.count("\n", 0, at)
        if do == "quote":
            parts = list(QUOTED.finditer(text))
            part = parts[round(where * (len(parts) - 1))] if parts else None
            text = text if part is None else text[: part.start(1)] + new + text[part.end(1) :]
        elif do == "cut":
            text = text[:at]
        elif do == "char":
            text = text[:at] + new[:1] + text[at + 1 :]
        else:
            text = "\n".join(lines[:row] + [lines[row]] * (2 if do == "twice" else 0) + lines[row + 1 :])
    return text.encode("utf-8", "replace")
