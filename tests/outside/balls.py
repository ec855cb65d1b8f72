"""Mistakes of a second C++ program, other in shape: changed lines of tests/cpp/castray_balls.cpp."""

from functools import partial

from suite import ROOT

from outside.cpp import diagnosed
from outside.mistake import Mistake

SOURCE = ROOT / "tests" / "cpp" / "castray_balls.cpp"


def _of(id, words, laws, changes, fair=()):
    return Mistake(
        f"balls {id}", words, laws, partial(diagnosed, changes, SOURCE, "cornell_glass"), fair, "fresh"
    )


_ROULETTE = '    CASTRAY_LOG("roulette.probability", q_survive, "roulette.survived", goes_on);'
_AT_MIRRORS = '        CASTRAY_LOG("roulette.probability", q_survive, "roulette.survived", survives);'
_NEXT_DEPTH = "    next.depth += 1;\n"
MISTAKES = (
    _of(
        "right",
        "no mistake: roulette is logged only where it is played",
        (),
        {
            _ROULETTE: _ROULETTE.replace("    CASTRAY", "    if (q_survive < 1) CASTRAY"),
            _AT_MIRRORS: _AT_MIRRORS.replace("    CASTRAY", "    if (q_survive < 1) CASTRAY"),
        },
    ),
    _of(
        "area-in-the-weight",
        "the weight of a met lamp compares a density per area",
        ("pdf-of-light", "emission-weight"),
        {"(before.density + other_light);": "(before.density + 1 / lamp->area());"},
        ("M01",),
    ),
    _of(
        "lamp-seen-from-eye",
        "the density at a met lamp is that from the eye",
        ("pdf-of-light",),
        {"    next.vertex = hit.at;\n": ""},
    ),
    _of(
        "fresnel-one-way",
        "Fresnel's indices are not swapped on the way out, Snell's are",
        ("bounce-mirror-f", "bounce-mirror-pdf"),
        {"F = fresnel(cosine, in, out)": "F = fresnel(cosine, 1, 1.5)"},
    ),
    _of(
        "mirrors-do-not-count",
        "depth does not grow at mirrors and glass",
        ("depth",),
        {_NEXT_DEPTH: "    next.depth += next.dirac ? 0 : 1;\n"},
    ),
    _of(
        "still-matt",
        "after a mirror the density is that of the bounce before it",
        ("pdf-of-last-bounce", "emission-weight"),
        {"    next.dirac = true;\n": ""},
        ("M02",),
    ),
    _of(
        "falloff-twice",
        "r^4 in the density of the lamp",
        ("light-pdf", "pdf-of-light"),
        {"? r2 / (cosine * lamp->area())": "? r2 * r2 / (cosine * lamp->area())"},
    ),
    _of(
        "half-mirrored",
        "d - n (n . d): a mirror that sends along itself",
        ("bounce-mirror", "unit-direction"),
        {"unit(d - 2 * dot(d, n) * n)": "unit(d - dot(d, n) * n)"},
    ),
    _of(
        "fresnel-not-paid",
        "what glass lets through is not divided by its probability",
        ("bounce-mirror-pdf",),
        {"chance = 1 - F;": "chance = 1;"},
    ),
    _of(
        "coin-for-fresnel",
        "mirrored by a coin, with the probability F",
        ("directions-beside",),
        {"dice.roll() < F": "dice.roll() < .5"},
    ),
    _of(
        "square-of-fresnel",
        "mirrored with F^2, with the probability F",
        ("directions-beside",),
        {"dice.roll() < F": "dice.roll() < F * F"},
    ),
    _of(
        "no-square-of-index",
        "what is let through is scaled by the index, not by its square",
        ("bounce-mirror-f",),
        {"(1 - F) * eta * eta * ones": "(1 - F) * eta * ones"},
    ),
    _of(
        "cosine-at-least",
        "the cosine of the bounce is at least 0.2",
        ("throughput", "bounce-cos"),
        {"V3 indirect = cos_bounce / pdf": "V3 indirect = std::max(cos_bounce, .2) / pdf"},
    ),
    _of(
        "paid-from-the-start",
        "divided by 0.8 before roulette is played",
        ("throughput", "roulette-weight"),
        {"/ pdf / q_survive *": "/ pdf / .8 *"},
    ),
    _of(
        "roulette-turns",
        "the number of the roulette is used again for the azimuth",
        ("directions", "directions-beside"),
        {
            "bool goes_on = dice.roll() < q_survive;": (
                "double u_survive = dice.roll();\n    bool goes_on = u_survive < q_survive;"
            ),
            "phi = 2 * pi * dice.roll()": "phi = 2 * pi * u_survive",
        },
        ("B09",),
    ),
    _of(
        "one-number",
        "one number gives height and azimuth",
        ("directions",),
        {"phi = 2 * pi * dice.roll()": "phi = 2 * pi * u"},
    ),
    _of(
        "bright-clamped",
        "what comes back from a bounce is at most 1",
        ("ledger", "throughput"),
        {
            "* f * deeper({at, wi}, hit, next, dice);": (
                "* f * dimmed(deeper({at, wi}, hit, next, dice));"
            ),
            "static V3 seen(const Ray &ray, Caller before, Dice &dice);": (
                "static V3 seen(const Ray &ray, Caller before, Dice &dice);\n"
                "static V3 dimmed(V3 a) { return {std::min(a.x, 1.), std::min(a.y, 1.), std::min(a.z, 1.)}; }"
            ),
        },
        ("F01",),
    ),
    _of(
        "lamps-only-sampled",
        "lamps that a bounce meets do not count, light samples are weighted all the same",
        ("emission-weight", "emission"),
        {"double w_own = before.dirac ? 1 : before.density / (before.density + other_light)": (
            "double w_own = before.dirac ? 1 : 0"
        )},
        ("M01",),
    ),
    _of(
        "lamps-are-black",
        "paths end at the lamp, which is white",
        ("light-due", "absorbed", "end"),
        {"    if (hit.surface->kind != MATT) {": (
            "    if (hit.shines) return CASTRAY_RETURN(own);\n    if (hit.surface->kind != MATT) {"
        )},
    ),
    _of(
        "one-quarter-of-the-lamp",
        "points on one quarter of the lamp only",
        ("lamp-points",),
        {"lamp->middle + (2 * dice.roll() - 1) * lamp->u": "lamp->middle + dice.roll() * lamp->u"},
    ),
    _of(
        "balls-without-shadow",
        "the balls throw no shadow",
        ("light-visible",),
        {"free = blocker.t > length * (1 - 1e-6);": (
            "free = blocker.t > length * (1 - 1e-6) || blocker.surface->kind != MATT;"
        )},
        ("D03",),
    ),
    _of(
        "frame-made-once",
        "the local frame is made at the first vertex and kept",
        ("bounce-side", "directions", "unit-direction", "bounce-pdf", "bounce-cos"),
        {"V3 s = unit(cross(n, other_axis))": "static const V3 s = unit(cross(n, other_axis))"},
        ("B05", "B17"),
    ),
    _of(
        "from-the-old-place",
        "the bounce leaves from where the ray came from",
        ("chain", "first-surface"),
        {"deeper({at, wi}, hit": "deeper({ray.from, wi}, hit"},
        ("B10",),
    ),
    _of(
        "arguments-swapped",
        "s and t exchanged with sine for height",
        ("directions", "bounce-pdf"),
        {"std::sqrt(1 - u) * n": "std::sqrt(u) * n", "std::sqrt(u) * std::cos(phi) * s": (
            "std::sqrt(1 - u) * std::cos(phi) * s"
        ), "std::sqrt(u) * std::sin(phi) * t": "std::sqrt(1 - u) * std::sin(phi) * t",
         "double u = dice.roll()": "double u = dice.roll() * .5"},
    ),
    _of(
        "glow-of-the-back",
        "the lamp's density without its cosine",
        ("light-pdf", "pdf-of-light"),
        {"? r2 / (cosine * lamp->area())": "? r2 / lamp->area()"},
    ),
)  # fmt: skip
