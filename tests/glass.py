"""Coloured glass whose light can be worked out: slabs, and what stands before and behind them."""

import numpy as np

import tracer

SIGMA_T = (0.4, 2.0, 9.0)  # per metre
THICK = 0.5


def filled(sigma_t=SIGMA_T, **more):
    """What fills a shape that only absorbs."""
    return {"type": "homogeneous", "albedo": 0.0, "sigma_t": sigma_t, **more}


def eye(origin=(0, 0, 4), target=(0, 0, 0), fov=0.01, size=(1, 1)):
    """A camera, by default one whose rays are all the same but for a hundredth of a degree."""
    return {
        "type": "perspective",
        "fov": fov,
        "to_world": [{"look_at": {"origin": list(origin), "target": list(target), "up": [0, 1, 0]}}],
        "film": {"width": size[0], "height": size[1]},
    }


def slab(index=1.5, material="dielectric", interior=None, thick=THICK, wide=50, **more):
    """A slab around z = 0."""
    return {
        "type": "cube",
        "to_world": [{"scale": [wide, wide, 0.5 * thick]}],
        "bsdf": {"type": material, "int_ior": index, "ext_ior": 1.0, **more},
        **({} if interior is None else {"interior": interior}),
    }


def lamp_behind(**shapes):
    """Shapes between a camera at z = 4 and a wide lamp at z = -3 of radiance 1."""
    lamp = {
        "type": "rectangle",
        "to_world": [{"scale": 60}, {"translate": [0, 0, -3]}],
        "emitter": {"type": "area", "radiance": 1.0},
    }
    return tracer.load_dict({"sensor": eye(), "lamp": lamp, **shapes})


def slab_shares(R, a, crossings=np.inf):
    """Shares of the light (transmitted, reflected) by a slab whose faces reflect R, of whose inside every way
    across leaves a.

    A path that gets through crosses the slab 2j + 1 times and is reflected inside 2j times:
    T = sum over j of (1 - R)^2 a (R a)^(2j) = (1 - R)^2 a / (1 - (R a)^2). One that comes back has crossed
    it 2j + 2 times: R + (1 - R)^2 R a^2 sum of (R a)^(2j). crossings: how many ways across count at most.
    """
    through, back, j = np.zeros_like(a), R + np.zeros_like(a), 0
    if np.isinf(crossings):
        series = (1 - R) ** 2 / (1 - (R * a) ** 2)
        return series * a, R + series * R * a * a
    while 2 * j + 1 <= crossings:
        through = through + (1 - R) ** 2 * a * (R * a) ** (2 * j)
        if 2 * j + 2 <= crossings:
            back = back + (1 - R) ** 2 * R * a * a * (R * a) ** (2 * j)
        j += 1
    return through, back


SMOOTH = {"type": "dielectric", "int_ior": 1.3, "ext_ior": 1.0}
ROUGH = {"type": "roughdielectric", "int_ior": 1.3, "ext_ior": 1.0, "alpha": 0.4, "distribution": "ggx"}


def lit_inside(material):
    """A grey ball and a lamp inside a large ball of coloured glass; the camera outside looks at the ball."""
    return tracer.load_dict(
        {
            "sensor": eye((0, 0, 7), (-0.5, -0.3, 0), fov=10, size=(24, 24)),
            "glass": {"type": "sphere", "radius": 2.0, "bsdf": material, "interior": filled((0.1, 0.4, 1.2))},
            "ball": {"type": "sphere", "center": [-0.6, -0.3, 0], "radius": 0.7},
            "lamp": {
                "type": "sphere",
                "center": [0.9, 0.4, 0.2],
                "radius": 0.6,
                "emitter": {"type": "area", "radiance": [3, 3, 3]},
            },
        }
    )
