"""Two normals at each point of a smooth mesh: how they are made, moved, and what goes wrong with them."""

import numpy as np

from tracer.shape import transform

SLOPE = np.array([[1.0], [1.0], [0.0]]) / np.sqrt(2.0)  # a normal of the question
STRETCH = np.diag([1.0, 2.0, 1.0, 1.0])  # twice as high


def experiment(run):
    """Angles in degrees, lengths of normals as they are."""
    hit, light = run.event("start"), run.event("light")
    n, ng, wi = (np.array(v) for v in (hit["n"], hit["ng"], light["wi"]))
    assert np.isclose(n @ n, 1.0, atol=1e-5) and np.isclose(ng @ ng, 1.0, atol=1e-5)
    assert np.isclose(light["cos"], n @ wi, rtol=1e-4)
    corners = triangle_normal(run)
    assert np.allclose(ng, corners, atol=1e-5)

    short = np.array(run.event("short")["n"])
    assert np.linalg.norm(short) < 1.0 and np.allclose(short / np.linalg.norm(short), n, atol=1e-5)
    leak, edge = run.event("leak"), np.array(run.event("rim")["ng"])
    assert leak["cos"] > 0.0 > edge @ np.array(leak["wi"])
    assert not np.array(leak["f"]).any() and np.array(run.event("leaks")["f"]).any()

    moved = transform.normals(STRETCH, SLOPE)[:, 0]
    assert np.isclose(moved @ (STRETCH[:3, :3] @ np.array([1.0, -1.0, 0.0])), 0.0)  # still across the slope
    as_point = STRETCH[:3, :3] @ SLOPE[:, 0]
    return {
        "angle": angle(n, ng),
        "angle_radians": np.radians(angle(n, ng)),
        "cosine": n @ ng,
        "angle_lamp": angle(n, wi),
        "short": np.linalg.norm(short),
        "moved_y": moved[1],
        "as_point_y": as_point[1] / np.linalg.norm(as_point),
        "unmoved_y": SLOPE[1, 0],
        "not_unit_y": SLOPE[1, 0] / 2.0,
        "turned_cos": run.event("stretched")["cos"],
        "long": np.linalg.norm(run.event("long")["n"]),
        "cos_ng": edge @ np.array(leak["wi"]),
    }


def triangle_normal(run):
    """The normal of the triangle that the lesson looks at, from its corners."""
    scene, primitive = run.scene(), run.event("start")["primitive"]
    shape = next(k for k, first in reversed(list(enumerate(scene.first))) if first <= primitive)
    mesh = scene.shapes[shape]
    a, b, c = mesh.vertices[mesh.faces[primitive - scene.first[shape]]]
    across = np.cross(b - a, c - a)
    return across / np.linalg.norm(across)


def angle(a, b):
    """Degrees between two unit vectors."""
    return float(np.degrees(np.arccos(np.clip(a @ b, -1.0, 1.0))))
