"""What castray and Mitsuba 3 both render: scenes that come with castray, and some made for one thing each.

A scene that the two define differently says so in `differs`, and has a sister that they define alike.
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from peer_definitions import COATS, MASKING, NAMED_METALS, SMOOTH_OUTLINES

import tracer
from tracer.bsdf.metals import METALS, index_of
from tracer.scene_file.load import BUILT_IN

BALL = str(BUILT_IN / "meshes" / "ball.ply")


@dataclass(frozen=True)
class PeerScene:
    """A scene for both programs; make(folder) gives it, and may leave files of its own in the folder."""

    key: str
    make: Callable
    differs: str = ""  # why the programs' pictures differ by definition
    as_peer: bool = False  # whether castray borrows the peer's definitions of rough surfaces and coats


def _built_in(key, scene=None, change=None, **words):
    """A scene that comes with castray; change(description) gives another description of it."""

    def make(folder):
        made = tracer.load(scene or key)
        if change is None:
            return made
        return tracer.load_dict(change(made.definition.source[0]), key, BUILT_IN)

    return PeerScene(key, make, **words)


def _own(key, describe, **words):
    """A scene made here: describe(folder) gives its tables."""
    return PeerScene(key, lambda folder: tracer.load_dict(describe(Path(folder)), key, folder), **words)


def with_indices(description):
    """The same scene with its named metals given by eta and k."""
    changed = dict(description)
    for name, table in description.items():
        if isinstance(table, dict) and table.get("material") in METALS:
            eta, k = (tuple(map(float, row)) for row in index_of(table["material"]))
            changed[name] = {**{w: v for w, v in table.items() if w != "material"}, "eta": eta, "k": k}
    return changed


def _camera(origin, target, fov, **more):
    look = {"origin": origin, "target": target, "up": [0, 1, 0]}
    film = {"width": 96, "height": 64}
    return {"type": "perspective", "fov": fov, "to_world": [{"look_at": look}], "film": film, **more}


def _lamp(radiance, *steps, **more):
    return {
        "type": "rectangle",
        "to_world": list(steps),
        "emitter": {"type": "area", "radiance": radiance},
        **more,
    }


_DOWN = {"rotate": [1, 0, 0], "angle": 90}  # of a rectangle, which faces +z
_UP = {"rotate": [1, 0, 0], "angle": -90}
_FLOOR = {"type": "rectangle", "to_world": [{"scale": 12}, _UP], "bsdf": "ground"}
_GROUND = {"type": "diffuse", "reflectance": [0.45, 0.4, 0.35]}


def _shelf(materials, shape=None):
    """A row of things, one of each material, on a floor under an even sky and a lamp."""
    shape = shape or {"type": "sphere", "radius": 0.9}
    count = len(materials)
    scene = {
        "eye": _camera([0, 2.4, 4.2 * count / 2 + 2.0], [0, 0.8, 0], 46),
        "sky": {"type": "constant", "radiance": [0.5, 0.6, 0.8]},
        "lamp": _lamp([14, 12, 9], {"scale": [1.6, 0.7, 1]}, _DOWN, {"translate": [-1, 5, 2]}),
        "ground": _GROUND,
        "floor": _FLOOR,
    }
    for k, material in enumerate(materials):
        place = {"translate": [2.0 * (k - 0.5 * (count - 1)), 0.95, 0]}
        scene[f"material_{k}"] = material
        scene[f"thing_{k}"] = {
            **shape,
            "to_world": [*shape.get("to_world", ()), place],
            "bsdf": f"material_{k}",
        }
    return scene


def _metals_and_panes(folder):
    return _shelf(
        [
            {"type": "conductor", "eta": (0.25, 0.96, 1.24), "k": (3.4, 2.58, 2.44)},
            {"type": "conductor", "material": "none", "specular_reflectance": (0.9, 0.7, 0.8)},
            {"type": "thindielectric", "int_ior": "diamond", "specular_transmittance": (0.9, 0.95, 1)},
            {"type": "dielectric", "int_ior": "water", "specular_transmittance": (0.95, 1, 0.9)},
        ]
    )


def _rough_metals(folder):
    copper = {"eta": (0.25, 0.96, 1.24), "k": (3.4, 2.58, 2.44)}
    return _shelf(
        [
            {"type": "roughconductor", "alpha": 0.08, "distribution": "ggx", **copper},
            {"type": "roughconductor", "alpha": 0.3, "distribution": "beckmann", **copper},
            {
                "type": "roughconductor",
                "alpha": 0.6,
                "distribution": "ggx",
                "specular_reflectance": (0.9, 0.8, 0.7),
            },
        ]
    )


def _rough_glass(folder):
    return _shelf(
        [
            {"type": "roughdielectric", "alpha": 0.3, "distribution": "ggx", "int_ior": 1.5},
            {"type": "roughdielectric", "alpha": 0.15, "distribution": "beckmann", "int_ior": 1.8},
            {"type": "roughdielectric", "alpha": 0.6, "distribution": "ggx", "specular_reflectance": 0.5},
        ]
    )


def _coats(folder):
    colour = {"diffuse_reflectance": (0.6, 0.25, 0.1)}
    return _shelf(
        [
            {"type": "plastic", **colour},
            {"type": "plastic", "nonlinear": True, "int_ior": 1.9, **colour},
            {"type": "roughplastic", "alpha": 0.1, "distribution": "ggx", **colour},
            {"type": "roughplastic", "alpha": 0.3, "distribution": "beckmann", "nonlinear": True, **colour},
        ]
    )


def _brushed(folder):
    metal = {"type": "roughconductor", "alpha_u": 0.05, "alpha_v": 0.4, "eta": 1.4, "k": 7.0}
    scene = _shelf([metal, {**metal, "distribution": "ggx"}, {**metal, "alpha_u": 0.3, "alpha_v": 0.1}])
    turned = {"rotate": [1, 1, 0], "angle": 50}
    scene["thing_1"] = {
        "type": "cube",
        "to_world": [{"scale": 0.6}, turned, {"translate": [0, 0.9, 0.5]}],
        "bsdf": "material_1",
    }
    scene["thing_2"] = {
        "type": "sphere",
        "to_world": [{"rotate": [1, 0, 0.4], "angle": 70}, {"translate": [2, 1, 0]}],
        "bsdf": "material_2",
    }
    scene["floor"] = {**_FLOOR, "bsdf": "material_0"}
    return scene


def _two_sided(folder):
    card = {"type": "rectangle", "to_world": [{"scale": [0.8, 1, 1]}, {"rotate": [0, 1, 0], "angle": 140}]}
    red = {"type": "diffuse", "reflectance": (0.7, 0.2, 0.1)}
    scene = _shelf(
        [
            red,
            {"type": "twosided", "inside": red},
            {"type": "twosided", "inside": {"type": "conductor", "eta": 1.4, "k": 7.0}},
            {"type": "diffuse", "reflectance": (0.1, 0.3, 0.6)},
        ],
        card,
    )
    scene["thing_0"] = {**scene["thing_0"], "flip_normals": True}
    return scene


def _lens(folder):
    grey = {"type": "diffuse", "reflectance": 0.6}
    scene = _shelf([grey, {"type": "diffuse", "reflectance": (0.7, 0.2, 0.1)}, grey])
    scene["eye"] = {**scene["eye"], "type": "thinlens", "aperture_radius": 0.4, "focus_distance": 7.0}
    scene["thing_0"]["to_world"] = [{"translate": [-2, 0.9, 3]}]
    scene["thing_2"]["to_world"] = [{"translate": [2, 0.9, -4]}]
    return scene


def _lamps(folder):
    shine = {"type": "area"}
    ball = {"type": "ply", "filename": BALL, "face_normals": True}
    return {
        "eye": _camera([0, 1.4, 6.5], [0, 1.1, 0], 46),
        "ground": _GROUND,
        "room": {
            "type": "cube",
            "flip_normals": True,
            "bsdf": "ground",
            "to_world": [{"scale": [4, 2, 8]}, {"translate": [0, 2, 0]}],
        },
        "pillar": {
            "type": "cube",
            "bsdf": "ground",
            "to_world": [
                {"scale": [0.3, 1, 0.3]},
                {"rotate": [0, 1, 0], "angle": 30},
                {"translate": [0.4, 1, 0.8]},
            ],
        },
        "globe": {
            "type": "sphere",
            "center": [-2, 1.2, 0],
            "radius": 0.3,
            "emitter": {**shine, "radiance": (9, 7, 4)},
        },
        "block": {
            "type": "cube",
            "to_world": [
                {"scale": [0.2, 0.5, 0.2]},
                {"rotate": [0, 0, 1], "angle": 40},
                {"translate": [2, 1.3, -1]},
            ],
            "bsdf": "ground",
            "emitter": {**shine, "radiance": (2, 4, 6)},
        },
        "lump": {
            **ball,
            "to_world": [{"scale": 0.3}, {"translate": [-0.8, 0.6, 1.5]}],
            "emitter": {**shine, "radiance": (6, 2, 3)},
        },
        "sheet": _lamp(
            (3, 3, 3),
            {"scale": [0.8, 0.4, 1]},
            {"rotate": [1, 0, 0], "angle": -70},
            {"translate": [0.6, 3.4, -2]},
            flip_normals=True,
            bsdf="ground",
        ),
        "bulb": {"type": "point", "position": [2.6, 3, 2], "intensity": (5, 4, 3)},
    }


def _environment(folder):
    rng = np.random.default_rng(5)
    sky = rng.uniform(0.2, 1.0, (8, 16, 3)).astype(np.float32)
    sky[2, 5] = 40.0  # a sun
    tracer.write(sky, folder / "sky.exr")
    scene = _shelf(
        [
            {"type": "diffuse", "reflectance": (0.7, 0.6, 0.5)},
            {"type": "conductor", "material": "none"},
            {"type": "dielectric"},
        ]
    )
    del scene["lamp"]
    turned = [{"rotate": [1, 2, 0.5], "angle": 35}]
    scene["sky"] = {"type": "envmap", "filename": "sky.exr", "scale": 0.8, "to_world": turned}
    return scene


def _smooth_dome(folder):
    """The middle of a ball of triangles, seen and lit from right in front, and nothing else."""
    return {
        "eye": _camera([0, 0, 6], [0, 0, 0], 10),
        "clay": {"type": "diffuse", "reflectance": (0.7, 0.45, 0.3)},
        "ball": {
            "type": "ply",
            "filename": BALL,
            "bsdf": "clay",
            "to_world": [{"scale": [1.4, 1, 0.8]}, {"rotate": [1, 2, 3], "angle": 25}],
        },
        "lamp": _lamp(
            (40, 30, 20), {"scale": 0.5}, {"rotate": [0, 1, 0], "angle": 180}, {"translate": [0.5, 0.4, 7]}
        ),
    }


SCENES = (
    *map(_built_in, ("cornell", "cornell_unit", "cornell_glass", "furnace", "glass_slab", "many_lights")),
    *map(_built_in, ("mirror_corridor", "sky")),
    _own("lamps", _lamps),
    _own("environment", _environment),
    _own("lens", _lens),
    _own("metals_and_panes", _metals_and_panes),
    _own("two_sided", _two_sided),
    _own("smooth_dome", _smooth_dome),
    _built_in("coloured_glass", as_peer=True),
    _built_in("materials_eta_k", "materials", with_indices, as_peer=True),
    _built_in("textures", change=with_indices, as_peer=True),
    _own("rough_metals", _rough_metals, as_peer=True),
    _own("rough_glass", _rough_glass, as_peer=True),
    _own("coats", _coats, as_peer=True),
    _own("brushed", _brushed, as_peer=True),
    _built_in("materials", differs=NAMED_METALS, as_peer=True),
    _own("rough_metals_own", _rough_metals, differs=MASKING),
    _own("coats_own", _coats, differs=COATS),
    _built_in("smooth_ball", differs=SMOOTH_OUTLINES),
)
