"""What tests of the gl engine share: mistakes in its shader, and its picture beside NumPy's."""

import numpy as np
from meshes import icosphere
from suite import ROOT

import tracer
from tracer import Settings
from tracer.engine.gl import source
from tracer.scene import Scene
from tracer.shape import Mesh
from tracer.testing import z_test

ALPHA = 1e-4  # chance that one comparison of pictures fails though all is right
FILES = sorted((ROOT / "tracer" / "engine" / "gl" / "glsl").rglob("*.glsl"))


def small(**options):
    """Settings of a small picture."""
    return Settings(**{"width": 16, "height": 16, "spp": 32, "max_depth": 8, **options})


def plant(monkeypatch, right, other):
    """A mistake in the shader: another text in place of one that must be there."""
    whole = source.text

    def text(name):
        return whole(name).replace(right, other)

    assert any(right in path.read_text(encoding="utf-8") for path in FILES)
    monkeypatch.setattr(source, "text", text)


def compared(scene, seed):
    """The z-test of pictures by both engines, of different random numbers."""
    pictures = [
        tracer.render(scene, small(seed=seed + k), engine=engine) for k, engine in enumerate(("numpy", "gl"))
    ]
    return z_test(*pictures, alpha=ALPHA)


def kinds_of_light(**more):
    """A floor, a ball and a leaf seen through a lens, with every kind of light that a shader knows."""
    placed = [{"rotate": [1, 0, 0], "angle": 90}, {"translate": [0, 1.2, 0]}]
    look = {"origin": [0.3, 0.4, 3.2], "target": [0, 0, 0], "up": [0, 1, 0]}
    area = {"type": "area", "radiance": [5, 4, 3]}
    return tracer.load_dict(
        {
            "type": "scene",
            "sensor": {
                "type": "thinlens",
                "fov": 60,
                "aperture_radius": 0.1,
                "focus_distance": 3.0,
                "to_world": [{"look_at": look}],
            },
            "sky": {"type": "constant", "radiance": [0.2, 0.2, 0.3]},
            "sun": {"type": "directional", "direction": [-0.3, -1, -0.2], "irradiance": [1, 1, 0.8]},
            "bulb": {"type": "point", "position": [0, 0.9, 0.5], "intensity": [3, 2, 1]},
            "grey": {"type": "diffuse", "reflectance": [0.6, 0.5, 0.4]},
            "leafy": {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": [0.3, 0.6, 0.3]}},
            "floor": {
                "type": "rectangle",
                "to_world": [{"scale": 2}, {"rotate": [1, 0, 0], "angle": -90}, {"translate": [0, -1, 0]}],
                "bsdf": "grey",
            },
            "leaf": {
                "type": "rectangle",
                "to_world": [{"scale": 0.5}, {"translate": [-1, 0, 0]}],
                "bsdf": "leafy",
            },
            "ball": {"type": "sphere", "center": [0.6, -0.4, 0.2], "radius": 0.6, "bsdf": "grey"},
            "ceiling": {"type": "rectangle", "to_world": [{"scale": 2}, *placed], "bsdf": "grey"},
            "lamp": {
                "type": "rectangle",
                "to_world": [{"scale": 0.4}, *placed],
                "bsdf": "grey",
                "emitter": area,
            },
            "moon": {
                "type": "sphere",
                "center": [-1, 0.8, 0.5],
                "radius": 0.2,
                "bsdf": "grey",
                "emitter": area,
            },
            "die": {
                "type": "cube",
                "to_world": [
                    {"scale": 0.1},
                    {"rotate": [1, 1, 0], "angle": 33},
                    {"translate": [0.9, 0.8, 0.4]},
                ],
                "bsdf": "grey",
                "emitter": area,
            },
            **more,
        }
    )


def under_the_sky(vertices, faces, **more):
    """A grey mesh in front of the camera, and nothing else, under a bright sky."""
    description = {
        "type": "scene",
        "sensor": {"type": "perspective", "fov": 90},
        "sky": {"type": "constant", "radiance": 1.0},
        "grey": {"type": "diffuse", "reflectance": 0.8},
        "mesh": {"type": "sphere", "center": [0, 0, 2], "radius": 1, "bsdf": "grey"},
    }
    made = tracer.load_dict(description).definition
    surface = made.surfaces[0]._replace(shape=Mesh("mesh", vertices, faces, **more))
    return Scene(made._replace(surfaces=(surface,), source=None), np.float32)


def blob():
    """5120 triangles with hollows that hide the sky."""
    vertices, faces = icosphere(4)
    vertices = vertices * (1.0 + 0.3 * np.sin(9.0 * vertices).prod(axis=1, keepdims=True))
    return under_the_sky(vertices + [0, 0, 1.6], faces)
