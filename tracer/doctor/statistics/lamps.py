"""Light points: which lamp, and where on it."""

import numpy as np

from tracer.doctor.statistics.cells import FEWEST, Cell, counts, means, square, uniform
from tracer.events import TECHNIQUES
from tracer.frame import Frame, dot
from tracer.light import rectangle, sphere
from tracer.light.faces import shining_faces

_AREA, _ANGLE, _CONE = (TECHNIQUES.index(name) for name in ("area", "solid_angle", "cone"))


def _single(evidence, kind, rows):
    """One sample of each pixel where samples are not independent."""
    if evidence.settings.sampler == "independent":
        return rows
    return rows[evidence("path.sample")[evidence.trace.tables[kind].path[rows]] == 0]


def chosen(evidence):
    """I16: how often each lamp, and each of its faces, is chosen."""
    light, primitive = evidence("light.light"), evidence("light.primitive")
    rows = _single(evidence, "light", np.arange(light.size))
    if rows.size < FEWEST:
        return
    found = np.bincount(light[rows], minlength=len(evidence.scene.light_names))
    p = counts(found, evidence.lamps.pick * rows.size)
    if p is not None:
        yield Cell(p, "how often each lamp is chosen", "light", rows, {"found": found})
    for number in np.unique(light[rows]):
        here = rows[(light[rows] == number) & (primitive[rows] >= 0)]
        faces = [f for f in _faces(evidence) if f.light == number]
        if len(faces) < 2 or here.size < FEWEST:
            continue
        area = np.array([f.area for f in faces])
        found = np.array([np.count_nonzero(primitive[here] == f.primitive) for f in faces])
        p = counts(found, area / area.sum() * here.size)
        if p is not None:
            yield Cell(p, "how often each face of a lamp is chosen", "light", here, {"found": found})


def _faces(evidence):
    scene = evidence.scene
    if "faces" not in evidence.__dict__:
        evidence.__dict__["faces"] = [
            face
            for k, surface in enumerate(scene.definition.surfaces)
            if surface.radiance is not None and surface.shape.name in scene.light_names
            for face in shining_faces(
                scene.light_names.index(surface.shape.name), scene.shapes[k], int(scene.first[k])
            )
        ]
    return evidence.__dict__["faces"]


def spread(evidence):
    """I16: where on its face a light point lies, as two numbers that are uniform if it is right."""
    rows = _single(evidence, "light", np.flatnonzero(evidence.before("light", "hit") >= 0))
    groups: dict = {}
    for face in _faces(evidence):
        here = rows[evidence("light.primitive")[rows] == face.primitive]
        if not here.size:
            continue
        way = evidence("light.technique")[here]
        for technique in np.unique(way):
            lanes = here[way == technique]
            placed = _placed(evidence, face, technique, lanes)
            if placed is not None:
                which = np.full(lanes.size, face.primitive)
                groups.setdefault((face.kind, int(technique)), []).append((lanes, which, *placed))
    for (kind, technique), parts in groups.items():
        lanes, which, a, b, raw = (np.concatenate(column, axis=-1) for column in zip(*parts, strict=True))
        if lanes.size < FEWEST:
            continue
        facts = {
            "shape": kind, "technique": TECHNIQUES[technique], "a": a, "b": b, "raw": raw, "primitive": which,
        }  # fmt: skip
        for p, text in _of_points(kind, which, a, b):
            yield Cell(p, text, "light", lanes, facts)


def _of_points(kind, which, a, b):
    """Yield (chance, words) of two numbers (N,) each of points on lamps of a kind; which: the face, (N,)."""
    yield uniform(a), f"first coordinate of points on {kind} lamps"
    yield uniform(b), f"second coordinate of points on {kind} lamps"
    if (p := square(a, b)) is not None:
        yield p, f"points on {kind} lamps"
    if which.min() < which.max():  # what the choice of the lamp has to do with the place on it
        yield means(a, which), f"first coordinate of points on each of the {kind} lamps"
        yield means(b, which), f"second coordinate of points on each of the {kind} lamps"


def _placed(evidence, face, technique, rows):
    """Two numbers (N,) that are uniform for points spread as they should be, and coordinates (2, N) on the
    face; None where there is no such map."""
    p, q = evidence.at_vertex("light", "p")[:, rows], evidence("light.q")[:, rows]
    if face.kind == "sphere":
        return _on_sphere(face, technique, p, q)
    x, e1, e2 = q - face.corner[:, None], face.e1, face.e2
    d11, d12, d22 = e1 @ e1, e1 @ e2, e2 @ e2
    y1, y2 = dot(e1, x), dot(e2, x)
    det = d11 * d22 - d12 * d12
    s, t = (d22 * y1 - d12 * y2) / det, (d11 * y2 - d12 * y1) / det
    raw = np.stack((s, t))
    if technique == _AREA:
        if face.kind == "triangle":  # the share below s + t, and the place along it
            total = s + t
            return total * total, t / np.where(total > 0.0, total, 1.0), raw
        return s, t, raw
    if technique != _ANGLE:
        return None
    size = np.sqrt(np.array([d11, d22]))
    seen = rectangle.seen_from(
        p, face.corner[:, None], (e1 / size[0])[:, None], (e2 / size[1])[:, None], face.n[:, None], *size
    )
    part = seen._replace(x1=seen.x0 + s * size[0], width=s * size[0])
    whole = rectangle.solid_angle(seen)
    level = (seen.x0 + s * size[0]) ** 2 + seen.z**2
    h0, h1, h = (y / np.sqrt(level + y * y) for y in (seen.y0, seen.y1, seen.y0 + t * size[1]))
    clear = np.flatnonzero(whole > 1e-4)  # where the digits are there
    if clear.size < whole.size:
        s, t = np.where(whole > 1e-4, s, np.nan), t
    a = np.where(whole > 1e-4, rectangle.solid_angle(part) / whole, s)
    b = (h - h0) / (h1 - h0)
    return np.where(np.isnan(a), raw[0], a), b, raw


def _on_sphere(face, technique, p, q):
    radius = face.e1[0]
    n = (q - face.corner[:, None]) / radius
    raw = np.stack(
        (np.arccos(np.clip(n[2], -1.0, 1.0)) / np.pi, np.arctan2(n[1], n[0]) / (2.0 * np.pi) % 1.0)
    )
    if technique == _AREA:
        return 0.5 * (1.0 - n[2]), raw[1], raw
    if technique != _CONE:
        return None
    out = p - face.corner[:, None]
    distance = np.sqrt(dot(out, out))
    axis = out / distance
    frame = Frame.around(axis)
    gap = q - p
    gap = gap / np.sqrt(dot(gap, gap))
    local = frame.to_local(gap)
    sine = local[0] ** 2 + local[1] ** 2
    drop = sine / (1.0 + np.sqrt(np.maximum(1.0 - sine, 0.0)))
    least = sphere.one_minus_cos(radius, distance)
    return drop / least, np.arctan2(local[1], local[0]) / (2.0 * np.pi) % 1.0, raw
