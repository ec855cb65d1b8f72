"""Fields of events that are worked out from others, and only for those who look.

Each is a pure function of (event, vertex, scene): columns of the event by name, columns of the last HIT of
the same paths, and the scene. What does not apply is NaN.
"""

import numpy as np

from tracer.frame import dot


def shape(event, vertex, scene):
    """Number of the shape a primitive belongs to, (N,)."""
    return scene.shape_of[event["primitive"]]


def bsdf(event, vertex, scene):
    """Number of the material of a primitive, (N,)."""
    return scene.bsdf_of[event["primitive"]]


def uv(event, vertex, scene):
    """Coordinates of a hit on its surface, (2, N)."""
    return scene.uv(event["p"], event["primitive"])


def albedo(event, vertex, scene):
    """The colour of the material there, (3, N)."""
    p, primitive = event["p"], event["primitive"]
    return scene.bsdf.colour(scene.bsdf_of[primitive], scene.painted(p, primitive))


def cos_wo(event, vertex, scene):
    """n . wo, (N,)."""
    return dot(event["n"], event["wo"])


def cos_light(event, vertex, scene):
    """Cosine at the light, negative behind it, (N,)."""
    return -dot(event["nq"], event["wi"])


def pdf_area(event, vertex, scene):
    """Density of a light point on its light's area in m^-2, (N,); 0 where the light has none."""
    cos = np.maximum(cos_light(event, vertex, scene), 0.0)
    density = event["pdf"] / event["pick"] * cos / (event["distance"] * event["distance"])
    return np.where(event["primitive"] >= 0, density, 0.0)


def blocker(event, vertex, scene):
    """First shape between a hit and its light point, (N,); -1 for none."""
    return scene.blocker(vertex, event)[0]


def blocker_distance(event, vertex, scene):
    """How far away that is, (N,); inf for none."""
    return scene.blocker(vertex, event)[1]


def _of_material(name, event, vertex, scene):
    frame = scene.frame(*(vertex[column] for column in ("n", "p", "primitive")))
    wo, wi = frame.to_local(vertex["wo"]), frame.to_local(event["wi"])
    p, primitive = vertex["p"], vertex["primitive"]
    return scene.bsdf.property(scene.bsdf_of[primitive], name, wo, wi, scene.painted(p, primitive))


def eta(event, vertex, scene):
    """Index of refraction across the surface as seen from wo, (N,)."""
    return _of_material("eta", event, vertex, scene)[0]


def F(event, vertex, scene):
    """Fresnel reflectance, (3, N)."""
    return _of_material("F", event, vertex, scene)


def D(event, vertex, scene):
    """Density of the facets' normals, (N,)."""
    return _of_material("D", event, vertex, scene)[0]


def G1(event, vertex, scene):
    """Share of the facets seen from wo, (N,)."""
    return _of_material("G1", event, vertex, scene)[0]


def G2(event, vertex, scene):
    """Share of the facets seen from wo and wi, (N,)."""
    return _of_material("G2", event, vertex, scene)[0]
