"""Mistakes of a C++ program with sixty lamps and MIS, often with little logged: changed lines of
tests/cpp/castray_hall.cpp."""

from functools import partial

from suite import ROOT

from outside.cpp import diagnosed
from outside.mistake import Mistake
from outside.weekend import FULL, NO_PDF, TERMS

SOURCE = ROOT / "tests" / "cpp" / "castray_hall.cpp"


def _of(id, words, laws, changes, level=FULL, fair=()):
    how = partial(diagnosed, changes, SOURCE, "many_lights", level)
    return Mistake(f"hall {id}", words, laws, how, fair, "third")


_BY_POWER = "chance[i] = luminance(radiance(i)) * area(i);"
MISTAKES = (
    _of("right", "no mistake", (), {}),
    _of(
        "right-by-mean",
        "no mistake: lamps are chosen by the mean of their colours, and no integrator is declared",
        (),
        {
            _BY_POWER: _BY_POWER.replace("luminance(radiance(i))", "dot(radiance(i), {1, 1, 1})"),
            '\\"integrator\\": \\"path\\", ': "",
        },
    ),
    _of(
        "right-evenly",
        "no mistake: each lamp is as likely as another",
        (),
        {_BY_POWER: "chance[i] = 1;"},
    ),
    _of(
        "met-lamp-is-first",
        "the density at a met lamp is with the first lamp's probability",
        ("pdf-of-light",),
        {"pdf_light = chance[hit.lamp]": "pdf_light = chance[0]"},
    ),
    _of(
        "weight-per-area",
        "the light sample's weight compares a density per area",
        ("light-term", "light-weight"),
        {"power_heuristic(pdf, pdf_bounce)": "power_heuristic(light.pick * light.pdf_area, pdf_bounce)"},
        NO_PDF,
        ("M01",),
    ),
    _of(
        "roulette-in-density",
        "the density that a met lamp is weighed with has the roulette in it",
        ("pdf-of-last-bounce", "emission-weight"),
        {"shade({p, next}, depth + 1, pdf_next)": "shade({p, next}, depth + 1, pdf_next * live)"},
        FULL,
        ("M01",),
    ),
    _of(
        "weight-without-choice",
        "the light sample's weight leaves out the lamp's probability",
        ("light-weight",),
        {"power_heuristic(pdf, pdf_bounce)": "power_heuristic(pdf / light.pick, pdf_bounce)"},
        FULL,
        ("M01",),
    ),
    _of(
        "half-a-bulb",
        "the density on a ball is that of half of it",
        ("light-pdf",),
        {"s.pdf_area = 1 / area(s.lamp);": "s.pdf_area = (s.lamp < PANELS ? 1 : 2) / area(s.lamp);"},
    ),
    _of(
        "last-lamp-lost",
        "the last lamp is never chosen",
        ("lamp-choice",),
        {"upto + LAMPS - 1, u)": "upto + LAMPS - 2, u)"},
    ),
    _of(
        "next-lamp",
        "the running sum is one lamp late",
        ("lamp-choice",),
        {"upto[i] = so_far += chance[i];": "upto[i] = so_far;\n        so_far += chance[i];"},
        NO_PDF,
    ),
    _of(
        "choice-again",
        "the number that chooses the lamp is its first coordinate, too",
        ("lamp-points",),
        {"float a = rnd(), b = rnd();\n    if (s.lamp": "float a = u, b = rnd();\n    if (s.lamp"},
        FULL,
        ("D17",),
    ),
    _of(
        "bulbs-inside-out",
        "the normals of lamps that are balls point inwards",
        ("light-normal",),
        {"s.q = middle(s.lamp) + s.n * l.size;": "s.q = middle(s.lamp) + s.n * l.size;\n        s.n = -s.n;"},
        NO_PDF,
    ),
    _of(
        "panels-both-sides",
        "light samples take the back of a lamp, too",
        ("light-term", "light-cos", "light-visible", "light-nothing"),
        {"cos_l = -dot(light.n, wi);": "cos_l = std::fabs(dot(light.n, wi));"},
        NO_PDF,
        ("E06",),
    ),
    _of(
        "one-sign",
        "the local frame is not made for normals along -z",
        ("unit-direction", "finite", "directions", "domain", "bounce-side", "chain", "bounce-before"),
        {"sign = std::copysign(1.f, n.z)": "sign = 1"},
        TERMS,
        ("B17",),
    ),
    _of(
        "whole-numbers",
        "the square of the distance is a whole number",
        ("light-term", "light-pdf"),
        {"light.pdf_area * r2 / cos_l": "light.pdf_area * int(r2) / cos_l"},
        NO_PDF,
    ),
    _of(
        "left-is-right",
        "the picture is mirrored",
        ("camera-ray",),
        {"normalize(front + right * a": "normalize(front - right * a"},
        TERMS,
        ("F06",),
    ),
    _of(
        "short-pillar",
        "the pillar is not as high as the scene's",
        ("first-surface", "on-surface"),
        {"{-1.1f, 2.4f, .4f}": "{-1.1f, 2, .4f}"},
        TERMS,
    ),
    _of(
        "colour-made-linear",
        "the albedo is taken for sRGB and made linear",
        ("light-f",),
        {"Vec f = ALBEDO / Pi": "float grey = std::pow(.6f, 2.2f);\n    Vec f = Vec{grey, grey, grey} / Pi"},
    ),
    _of(
        "weight-not-used",
        "the light sample's weight is worked out and not multiplied",
        ("light-term",),
        {"(cos_i * weight / pdf)": "(cos_i / pdf)"},
        FULL,
        ("M01",),
    ),
)
