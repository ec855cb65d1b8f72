"""What can happen to a path: the one schema. All who read events derive from it."""

from tracer import derived
from tracer.event import Field, Kind

END_REASONS = ("escaped", "absorbed", "roulette", "max_depth", "black", "invalid")
UNSAID = "unsaid"  # of a path whose log does not tell why it ended
TECHNIQUES = ("area", "solid_angle", "cone", "delta", "image")
LOBES = ("none", "diffuse", "reflection", "transmission")


def _transmittance(way):
    """What is left of the light after a way through the inside of glass; 1 where there is none."""
    return Field("transmittance", f"share of the light that gets {way}", (3,), "probability", otherwise=1.0)


def _microfacet():
    """What stands behind f at a boundary with Fresnel's reflectance; NaN where it does not apply."""
    return (
        Field(
            "F",
            "Fresnel reflectance, at a rough boundary that of the facet",
            (3,),
            "probability",
            derive=derived.F,
        ),
        Field(
            "D", "density of the facets' normals that send wi to wo", (), "density", "1/sr", derive=derived.D
        ),
        Field(
            "G1",
            "share of the facets facing wo that is seen from there",
            (),
            "probability",
            derive=derived.G1,
        ),
        Field(
            "G2",
            "share of the facets that is seen from both wo and wi",
            (),
            "probability",
            derive=derived.G2,
        ),
    )


CAMERA = Kind(
    "camera",
    "A ray leaves the camera through a point of the film.",
    (
        Field("film", "where on the film, in pixels from the top left", (2,), "real", "px"),
        Field("o", "origin of the ray", (3,), "point", "m"),
        Field("d", "direction of the ray", (3,), "unit vector"),
        Field("beta", "throughput so far", (3,), "non-negative"),
    ),
)
HIT = Kind(
    "hit",
    "The ray meets a surface; if that surface shines, its light counts here.",
    (
        Field("p", "point on the surface", (3,), "point", "m"),
        Field("t", "distance from the start of the ray", (), "positive", "m"),
        Field("primitive", "number of the flat face or sphere in the scene", (), "index"),
        Field("shape", "which shape", (), "shape", derive=derived.shape),
        Field("bsdf", "which material", (), "bsdf", derive=derived.bsdf),
        Field(
            "uv", "coordinates on the surface, where a texture is looked up", (2,), "real", derive=derived.uv
        ),
        Field(
            "albedo",
            "colour there: what a diffuse surface or base reflects, metal head on, or glass lets through",
            (3,),
            "probability",
            derive=derived.albedo,
        ),
        Field("ng", "geometric normal", (3,), "unit vector"),
        Field("n", "shading normal", (3,), "unit vector"),
        Field("wo", "direction back along the path", (3,), "unit vector"),
        Field("cos_wo", "cosine between n and wo", (), "cosine", derive=derived.cos_wo),
        Field("front", "whether the ray came from the side of ng", (), "flag"),
        _transmittance("through what fills the way here"),
        Field("beta", "throughput on arrival", (3,), "non-negative"),
        Field("Le", "radiance the surface itself sends along wo", (3,), "non-negative", "W/m²/sr"),
        Field(
            "pdf_bsdf",
            "density with which the last bounce chose this direction, inf after the camera or a mirror",
            (),
            "density",
            "1/sr",
        ),
        Field(
            "pdf_light",
            "density with which light sampling would have given this direction, 0 if it cannot",
            (),
            "density",
            "1/sr",
        ),
        Field("w", "MIS weight of finding this light by bouncing", (), "probability"),
        Field("contribution", "what this adds to the path's radiance", (3,), "non-negative", "W/m²/sr"),
    ),
)
LIGHT = Kind(
    "light",
    "A point on a light is sampled for direct illumination.",
    (
        Field("light", "which light", (), "light"),
        Field(
            "primitive",
            "number of the flat face or sphere of the light that q lies on, -1 if on none",
            (),
            "index",
        ),
        Field("pick", "probability of choosing this light", (), "probability"),
        Field("technique", "how the point was chosen", (), "choice", choices=TECHNIQUES),
        Field("q", "point on the light", (3,), "point", "m"),
        Field("nq", "normal of the light at q", (3,), "unit vector"),
        Field("wi", "direction to q", (3,), "unit vector"),
        Field("distance", "distance to q", (), "positive", "m"),
        Field(
            "Le",
            "radiance the light sends back along wi; of a delta light the irradiance facing it",
            (3,),
            "non-negative",
            "W/m²/sr",
        ),
        Field("visible", "whether q is seen (not asked where nothing could arrive)", (), "flag"),
        Field("blocker", "first shape in the way, -1 if none", (), "shape", derive=derived.blocker),
        Field(
            "blocker_distance",
            "distance to what is in the way",
            (),
            "distance",
            "m",
            derive=derived.blocker_distance,
        ),
        _transmittance("through what fills the way from q"),
        Field("f", "BSDF from wi to wo, without the cosine", (3,), "non-negative", "1/sr"),
        Field("cos", "cosine between n and wi (absolute)", (), "cosine"),
        Field("cos_light", "cosine at the light, negative behind it", (), "cosine", derive=derived.cos_light),
        Field(
            "pdf_area",
            "density of q on its light's area, 0 if it is no shape",
            (),
            "density",
            "1/m²",
            derive=derived.pdf_area,
        ),
        Field(
            "pdf",
            "density of wi, choice of the light included; of a delta light only that choice",
            (),
            "density",
            "1/sr",
        ),
        Field(
            "pdf_bsdf",
            "density with which a bounce would have given wi; 0 if none meets the light",
            (),
            "density",
            "1/sr",
        ),
        *_microfacet(),
        Field("w", "MIS weight of finding this light by sampling it", (), "probability"),
        Field("beta", "throughput at this vertex", (3,), "non-negative"),
        Field("u", "the random numbers: choice of the light, and of the point", (3,), "probability"),
        Field("contribution", "what this adds to the path's radiance", (3,), "non-negative", "W/m²/sr"),
    ),
)
BOUNCE = Kind(
    "bounce",
    "The surface chooses where the path goes on.",
    (
        Field("lobe", "which part of the BSDF was chosen", (), "choice", choices=LOBES),
        Field("wi", "the new direction", (3,), "unit vector"),
        Field(
            "f",
            "BSDF from wi to wo, without the cosine; at a Dirac lobe the reflected or transmitted fraction",
            (3,),
            "non-negative",
            "1/sr",
        ),
        Field("cos", "cosine between n and wi (absolute)", (), "cosine"),
        Field("pdf", "density of wi; at a Dirac lobe a probability", (), "density", "1/sr"),
        Field("delta", "whether the lobe is a Dirac one (its cosine cancels)", (), "flag"),
        Field(
            "eta",
            "index of refraction across the surface, as seen from wo",
            (),
            "positive",
            derive=derived.eta,
        ),
        *_microfacet(),
        Field("u", "the random numbers: choice of the lobe, and of the direction", (3,), "probability"),
        Field("beta_before", "throughput before the bounce", (3,), "non-negative"),
        Field("beta", "throughput after the bounce", (3,), "non-negative"),
    ),
)
ROULETTE = Kind(
    "roulette",
    "Russian roulette: the path ends, or goes on with more weight.",
    (
        Field("probability", "chance to go on", (), "probability"),
        Field("u", "the number drawn", (), "probability"),
        Field("survived", "whether the path goes on", (), "flag"),
        Field("beta", "throughput after it", (3,), "non-negative"),
    ),
)
ESCAPE = Kind(
    "escape",
    "The ray leaves the scene.",
    (
        Field("d", "direction of the ray", (3,), "unit vector"),
        Field("Le", "radiance of the environment", (3,), "non-negative", "W/m²/sr"),
        Field("pdf_light", "density with which light sampling would have given d", (), "density", "1/sr"),
        Field("w", "MIS weight of finding the environment by bouncing", (), "probability"),
        Field("contribution", "what this adds to the path's radiance", (3,), "non-negative", "W/m²/sr"),
    ),
)
END = Kind(
    "end",
    "The path is over.",
    (
        Field("reason", "why", (), "choice", choices=END_REASONS),
        Field("radiance", "sum of the path's contributions", (3,), "non-negative", "W/m²/sr"),
    ),
)
KINDS = (CAMERA, HIT, LIGHT, BOUNCE, ROULETTE, ESCAPE, END)
