"""Mistakes of a C++ program in the manner of the weekend books, often with little logged: changed lines of
tests/cpp/castray_weekend.cpp."""

from functools import partial

from suite import ROOT

from outside.cpp import diagnosed
from outside.mistake import Mistake

SOURCE = ROOT / "tests" / "cpp" / "castray_weekend.cpp"
FULL, NO_PDF, NO_LIGHT, TERMS = ((), ("-DLOG_NO_PDF",), ("-DLOG_NO_LIGHT",), ("-DLOG_TERMS",))


def _of(id, words, laws, changes, level=FULL, fair=()):
    how = partial(diagnosed, changes, SOURCE, "cornell_glass", level)
    return Mistake(f"weekend {id}", words, laws, how, fair, "third")


_DIRECT = "direct = cosine * cos_light / (distance * distance) / pdf_area * (lamp.mat->emitted * f);"
_FACTOR = "float factor = (s.specular ? 1 : s.cosine) / s.pdf / survive;"
_SUM = "return CASTRAY_RETURN(emission + direct + indirect);"
MISTAKES = (
    _of("right", "no mistake", (), {}),
    _of(
        "other-side-of-fresnel",
        "Fresnel's indices are exchanged, Snell's are not",
        ("bounce-mirror-f", "bounce-mirror-pdf"),
        {"float F = fresnel(cos_i, ratio)": "float F = fresnel(cos_i, 1 / ratio)"},
    ),
    _of(
        "square-of-index-inverted",
        "radiance is scaled by the square of the index the wrong way round",
        ("bounce-mirror-f",),
        {"(1 - F) * ratio * ratio;": "(1 - F) / (ratio * ratio);"},
        NO_PDF,
        ("S06",),
    ),
    _of(
        "camera-not-unit",
        "the camera's rays are not unit",
        ("unit-direction", "first-surface", "on-surface", "camera-ray"),
        {"ray{vec3(0, 0, 3.9f), unit_vector(d)}": "ray{vec3(0, 0, 3.9f), d}"},
        TERMS,
    ),
    _of(
        "glass-not-turned",
        "the normal is not turned where the ray leaves the glass",
        ("bounce-mirror", "bounce-side", "unit-direction"),
        {
            "vec3 across = ratio * (in.dir + cos_i * rec.normal);": (
                "vec3 n = rec.front_face ? rec.normal : -rec.normal;\n"
                "            vec3 across = ratio * (in.dir + cos_i * n);"
            ),
            "std::sqrt(std::fabs(1 - dot(across, across))) * rec.normal": (
                "std::sqrt(std::fabs(1 - dot(across, across))) * n"
            ),
        },
    ),
    _of(
        "half-a-lamp",
        "the lamp's area is that of a triangle",
        ("light-term", "light-pdf"),
        {"pdf_area = 1 / lamp.area()": "pdf_area = 2 / lamp.area()"},
        NO_PDF,
    ),
    _of(
        "disk-without-root",
        "the disk under the hemisphere is sampled without a root",
        ("directions",),
        {"radius = std::sqrt(r2);": "radius = r2;", "std::sqrt(1 - r2));": "std::sqrt(1 - r2 * r2));"},
        FULL,
        ("B01",),
    ),
    _of(
        "cosine-of-the-eye",
        "the bounce's cosine is that of wo",
        ("throughput", "bounce-cos"),
        {_FACTOR: _FACTOR.replace("s.cosine", "std::fabs(dot(r.dir, rec.normal))")},
        NO_LIGHT,
    ),
    _of(
        "dead-without-direct",
        "paths that roulette ends lose their light sample",
        ("ledger",),
        {
            "if (!alive) return CASTRAY_RETURN(emission + direct);": (
                "if (!alive) return CASTRAY_RETURN(emission);"
            )
        },
        TERMS,
    ),
    _of(
        "sum-by-roulette",
        "the whole sum is divided by the probability of survival, not the bounce",
        ("ledger", "throughput", "roulette-weight"),
        {_FACTOR: _FACTOR.replace(" / survive", ""), _SUM: _SUM.replace("indirect)", "indirect) / survive")},
        TERMS,
        ("D21",),
    ),
    _of(
        "child-twice",
        "what the bounce brings is added twice",
        ("ledger",),
        {_SUM: _SUM.replace("+ indirect", "+ indirect + indirect")},
        TERMS,
    ),
    _of(
        "colour-before",
        "a bounce has the colour of the vertex before",
        ("bounce-f",),
        {
            "s.value = kd / pi;": "static color last;\n        s.value = last / pi;\n        last = kd;",
        },
        NO_LIGHT,
    ),
    _of(
        "lamp-by-cosine",
        "the lamp's light is weighted by a cosine of its own",
        ("emission", "emission-term", "light-term", "light-radiance"),
        {
            _DIRECT: _DIRECT.replace("cosine *", "cosine * cos_light *"),
            "emission = rec.mat->emitted;": "emission = dot(-r.dir, rec.normal) * rec.mat->emitted;",
        },
        NO_PDF,
    ),
    _of(
        "shadow-from-zero",
        "the shadow ray meets the surface that it leaves",
        ("light-visible",),
        {"world.hit(ray{rec.p, wi}, shadow_bias,": "world.hit(ray{rec.p, wi}, 0,"},
        NO_PDF,
        ("G03",),
    ),
    _of(
        "mirror-by-cosine",
        "1 / cos at a mirror, where no cosine is multiplied",
        ("bounce-mirror-f",),
        {"s.value = color(1, 1, 1);": "s.value = color(1, 1, 1) / s.cosine;"},
    ),
    _of(
        "width-less-one",
        "the picture is one pixel too narrow",
        ("camera-ray", "camera-pixel", "camera-start", "film"),
        {
            "(x + random_float()) / PICTURE, v = (y + random_float()) / PICTURE": (
                "(x + random_float()) / (PICTURE - 1), v = (y + random_float()) / (PICTURE - 1)"
            )
        },
        TERMS,
    ),
    _of(
        "beside-the-lamp",
        "points on the lamp from -1 to 1, where they go from 0 to 1",
        ("light-point", "light-points"),
        {"q = lamp.Q + a * lamp.u + b * lamp.v": "q = lamp.Q + (2 * a - 1) * lamp.u + (2 * b - 1) * lamp.v"},
        NO_PDF,
    ),
    _of(
        "mirrors-hide-lamps",
        "a lamp counts by mirrors from the eye only, not after a matt surface",
        ("emission-weight", "emission-term", "emission"),
        {"ray_color(next, depth + 1, s.specular)": "ray_color(next, depth + 1, see_lamp && s.specular)"},
        TERMS,
    ),
)
