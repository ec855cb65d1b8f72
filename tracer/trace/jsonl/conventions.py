"""A log's units and conventions turned into castray's, and a look at whether it keeps what it declares."""

import numpy as np

from tracer.events import KINDS
from tracer.frame import dot
from tracer.trace.jsonl.schema import UNITS, call_fields

_MOST = 0.98  # share of vertices that tells a convention from a mistake


def _places(columns):
    """(place "kind.field" or name of a call's own, mask, column) of all values."""
    for kind, found in columns.items():
        for name in found.values:
            yield (f"{kind}.{name}" if kind else name), found, name


def _units():
    units = {name: f.unit for name, f in call_fields().items()}
    return units | {f"{kind.name}.{f.name}": f.unit for kind in KINDS for f in kind.fields}


def convert(columns, header, scene):
    """Turn columns (name of a kind or None -> Columns) into the scene's units and castray's conventions."""
    factor, units = unit_of(columns, header, scene), _units()
    width, height = header.options.get("width"), header.options.get("height")
    for place, found, name in _places(columns):
        unit = units.get(place, "")
        if unit in ("m", "1/m²") and factor != 1.0:
            found.values[name] *= factor if unit == "m" else factor**-2
        last = place.rpartition(".")[2]
        if last in ("wi", "wo") and header.turned[last] == "inward":
            found.values[name] *= -1
        if last in ("n",) and header.turned["n"] == "flipped":
            found.values[name] *= -1
        if name == "x" and header.turned["x"] == "left" and width:
            found.values[name] = width - 1 - found.values[name]
        if name == "y" and header.turned["y"] == "up" and height:
            found.values[name] = height - 1 - found.values[name]


def _points(columns):
    for kind, name in ((None, "hit.p"), ("hit", "p")):
        if kind in columns and name in columns[kind].values:
            found = columns[kind]
            p = found.values[name][:, found.given[name]].astype(np.float64)
            return p[:, np.isfinite(p).all(axis=0)]
    return np.empty((3, 0))


def _fits(p, factor, scene):
    """Whether points times a factor fill the scene."""
    low, high = scene.bounds()
    room = 1e-2 * (high - low).max()
    inside = ((p * factor >= (low - room)[:, None]) & (p * factor <= (high + room)[:, None])).all(axis=0)
    if inside.mean() < 0.9:
        return False
    return np.ptp(p * factor, axis=1).max() >= 0.1 * (high - low).max()


def unit_of(columns, header, scene):
    """Scene units per unit of the log. A name stands for metres, or for the scene's own unit if the points
    fill the scene as they are."""
    if header.unit is not None:
        return header.unit
    p = _points(columns)
    return 1.0 if p.size == 0 or _fits(p, 1.0, scene) else UNITS[header.unit_name]


def complaints(columns, header, scene):
    """Sentences on what is surely declared wrong, for columns as they are logged (before `convert`)."""
    return [*_of_units(columns, header, scene), *_of_ways(columns, header)]


def _of_units(columns, header, scene):
    p = _points(columns)
    factor = unit_of(columns, header, scene)
    if p.shape[1] < 16 or _fits(p, factor, scene):
        return
    for power in range(-6, 7):
        if _fits(p, 10.0**power, scene):
            yield (
                f"your points are {1 / 10.0**power:g} times as large as {scene.name}: "
                f'declare "unit": {10.0**power:g} in the header'
            )
            return
    low, high = (np.round(corner, 3).tolist() for corner in (p.min(axis=1), p.max(axis=1)))
    yield f"your points reach from {low} to {high}: they do not fit {scene.name}; is it the right --scene?"


def _of_ways(columns, header):
    """wo against the rays, wi against n and against the way to the light point."""
    if None not in columns:
        return
    found = columns[None]
    says = _pairs(found)
    for name, pairs in says.items():
        cosines = np.concatenate([c for c in pairs if c.size] or [np.empty(0)])
        cosines = cosines[np.isfinite(cosines)]
        if cosines.size < 16:
            continue
        turned = header.turned[name] == "inward"
        against = float(np.mean((cosines > 0.0) if turned else (cosines < 0.0)))
        if against >= _MOST:
            way, other = ("leaves", "outward") if turned else ("points into", "inward")
            yield f'your {name} {way} the surface at every vertex: declare "{name}": "{other}" in the header'


def _pairs(found):
    """wi, wo -> lists of products (K,) that are positive if they leave the surface."""

    def both(*names):
        if not all(name in found.values for name in names):
            return None
        rows = np.logical_and.reduce([found.given[name] for name in names])
        return [found.values[name][:, rows].astype(np.float64) for name in names]

    pairs = {"wo": [], "wi": []}
    if given := both("hit.wo", "ray.d"):
        pairs["wo"].append(-dot(*given))
    elif given := both("hit.wo", "hit.n"):
        pairs["wo"].append(dot(*given))
    if given := both("light.wi", "light.q", "hit.p"):
        pairs["wi"].append(dot(given[0], given[1] - given[2]))
    elif given := both("light.wi", "hit.n"):
        pairs["wi"].append(dot(*given))
    if given := both("bounce.wi", "hit.n"):
        pairs["wi"].append(dot(*given))
    return pairs


def none_of(scene):
    """What is said where no vertex lies on any surface."""
    return f"no vertex lies on a surface of {scene.name}: is the log of another scene?"


def complaints_of_scene(chain, places, scene, settings, header):
    """What shows only beside the scene: turned normals, a mirrored picture, points on no surface."""
    yield from _of_normals(chain, places, header)
    yield from _of_pixels(chain, places, scene, settings, header)
    nowhere, of = (int(np.count_nonzero(places.hit & some)) for some in (places.primitive < 0, True))
    if nowhere == of > 0:
        yield none_of(scene)
    elif nowhere:
        line = int(chain.columns.line[np.flatnonzero(places.hit & (places.primitive < 0))[0]])
        yield f"{nowhere} vertices lie on no surface of {scene.name}, the first in line {line}"


def _of_normals(chain, places, header):
    given = chain.given("hit.n") & (places.primitive >= 0)
    if np.count_nonzero(given) < 16:
        return
    along = dot(places.n[:, given], places.ng[:, given])
    turned = float(np.mean(along < -0.5))
    if turned >= _MOST:
        right = "surface" if header.turned["n"] == "flipped" else "flipped"
        yield f'your n is turned round at every vertex: declare "n": "{right}" in the header'
    elif turned > 0.0 and header.turned["n"] == "surface":
        wrong = along < -0.5
        towards = dot(places.n[:, given], places.wo[:, given]) > 0.0
        back = dot(places.ng[:, given], places.wo[:, given]) < 0.0
        if (towards[wrong] & back[wrong]).mean() >= _MOST and towards.mean() >= _MOST:
            yield 'your n is turned towards the ray: declare "n": "facing" in the header'


def _of_pixels(chain, places, scene, settings, header):
    """Whether rays go through the pixels that they are logged for."""
    if not (chain.given("ray.d").any() and all(k in header.options for k in ("width", "height"))):
        return
    root = np.flatnonzero(chain.level == 0)
    if root.size < 16 or "x" not in chain.columns.values:
        return
    x, y = (chain.columns.values[name][root] + 0.5 for name in ("x", "y"))
    width, height = settings.width, settings.height

    def off(x, y):
        _, d = scene.camera.rays(np.stack((x, y)), width, height, np.float64)
        return float(np.median(1.0 - dot(d, places.d[:, root])))

    here = off(x, y)
    near = (2.0 * np.tan(np.radians(scene.camera.fov_x / 2)) / width) ** 2 * 4.0  # two pixels
    if here <= near:
        return
    for name, other, way in (("x", (width - x, y), "left"), ("y", (x, height - y), "up")):
        if off(*other) <= near:
            right = way if header.turned[name] in ("right", "down") else {"x": "right", "y": "down"}[name]
            yield f'your picture is mirrored: declare "{name}": "{right}" in the header'
            return
    yield "your camera rays do not go through their pixels: is it this scene's camera, and the right size?"
