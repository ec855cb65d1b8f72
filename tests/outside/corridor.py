"""Mistakes of a recursive C++ program with closures, mirrors and a ball for a lamp: changed lines of
tests/cpp/castray_corridor.cpp. LITTLE logs points, normals, rays and terms only."""

from functools import partial

from suite import ROOT

from outside.cpp import diagnosed
from outside.mistake import Mistake

SOURCE = ROOT / "tests" / "cpp" / "castray_corridor.cpp"
LITTLE = ("-DLITTLE",)


def _of(id, words, laws, changes, flags=(), fair=()):
    how = partial(diagnosed, changes, SOURCE, "mirror_corridor", flags)
    return Mistake(f"corridor {id}", words, laws, how, fair, "fourth")


_MIRROR = "if (!here.paint.mirror) {"
_SUM = "return CASTRAY_RETURN(glow + direct + indirect);"
_PRODUCT = "{{a[0] * b[0], a[1] * b[1], a[2] * b[2]}}"
MISTAKES = (
    _of("right", "no mistake; floats, 9 digits", (), {}),
    _of("right-doubles", "no mistake; doubles, 12 digits", (), {}, ("-DDOUBLES", "-DDIGITS=12")),
    _of("right-6-digits", "no mistake; floats, 6 digits", (), {}, ("-DDIGITS=6",)),
    _of("right-little", "no mistake; little is logged", (), {}, LITTLE),
    _of("right-little-6", "no mistake; little is logged, 6 digits", (), {}, ("-DLITTLE", "-DDIGITS=6")),
    _of(
        "right-direct-0",
        "no mistake; at mirrors a direct light of 0 is logged",
        (),
        {
            '        CASTRAY_LOG("direct", direct);': "",
            'CASTRAY_LOG("indirect", indirect);': 'CASTRAY_LOG("direct", direct, "indirect", indirect);',
        },
    ),
    _of(
        "half-the-ball",
        "points all over the lamp, the density of half of it",
        ("light-pdf", "lamp-points"),
        {"1 / (4 * PI * RADIUS * RADIUS)": "1 / (2 * PI * RADIUS * RADIUS)"},
    ),
    _of(
        "normal-from-origin",
        "the lamp's normal is the direction of its point from the origin of the world",
        ("light-normal",),
        {"l.nq = s;": "l.nq = unit(l.q);"},
    ),
    _of(
        "shadow-hit-stays",
        "what the shadow ray met stays in the vertex: the bounce starts there",
        ("chain", "first-surface", "bounce-side", "bounce-f", "bounce-pdf", "bounce-cos", "throughput"),
        {
            "Lit lit() const {": "Lit lit() {",
            "Touch seen = follow({p, l.to});": "Touch seen = follow({p, l.to});\n"
            "        if (seen.paint) p = seen.p, n = seen.n;",
        },
        fair=("B10",),
    ),
    _of(
        "mirror-lit-too",
        "a mirror is lit by the lamp like a wall of its colour",
        ("light-f", "light-due", "light-term"),
        {_MIRROR: "{"},
    ),
    _of(
        "once-mirror-always",
        "after a mirror the lamp counts for the rest of the path: the flag is never taken back",
        ("emission-weight",),
        {
            "depth + 1, here.paint.mirror);": "depth + 1, here.paint.mirror || (depth > 0 && bulb_counts));",
        },
        fair=("E01",),
    ),
    _of(
        "within-the-ball",
        "normal plus a point within the unit ball, not on it, with the density of the cosine",
        ("directions",),
        {"Triple to = n + on_sphere();": "Triple to = n + std::cbrt(roll()) * on_sphere();"},
        fair=("B01",),
    ),
    _of(
        "blue-times-green",
        "the product of two colours takes the second one's green for its blue",
        ("light-term", "throughput", "ledger", "emission-term"),
        {_PRODUCT: _PRODUCT.replace("a[2] * b[2]", "a[2] * b[1]")},
    ),
    _of(
        "half-and-jitter",
        "half a pixel and a random number: rays fall half a pixel to the right",
        ("camera-pixel", "film", "camera-ray"),
        {"2 * (x + roll())": "2 * (x + real(0.5) + roll())"},
    ),
    _of(
        "distance-from-eye",
        "the distance to the lamp is that from the start of the ray that came",
        ("light-distance", "light-term"),
        {
            "l.far = norm(l.q - p);": "l.far = norm(l.q - from);",
            "l.to = 1 / l.far * (l.q - p);": "l.to = unit(l.q - p);",
            "seen.t > l.far -": "seen.t > norm(l.q - p) -",
            "Triple p, n, back;": "Triple p, n, back, from;",
            "real(-1) * beam.along);": "real(-1) * beam.along);\n    here.from = beam.from;",
        },
    ),
    _of(
        "next-paint",
        "the ceiling has the floor's colour: an index into the list of paints is one off",
        ("light-term", "throughput", "light-f", "bounce-f"),
        {"side_of_room(1, 1, WALL)": "side_of_room(1, 1, WOOD)"},
        LITTLE,
    ),
    _of(
        "mean-of-the-two",
        "direct and indirect light are averaged",
        ("ledger", "light-term"),
        {_SUM: "return CASTRAY_RETURN(glow + real(0.5) * (direct + indirect));"},
        LITTLE,
    ),
    _of(
        "cosine-as-density",
        "the density of a bounce is the cosine, not divided by pi",
        ("throughput", "bounce-pdf"),
        {"dot(n, to) / PI};": "dot(n, to)};"},
        LITTLE,
        ("B01",),
    ),
    _of(
        "starts-far-out",
        "the next ray starts 5 cm along its way",
        ("chain", "first-surface"),
        {"radiance({here.p, next.to}": "radiance({here.p + real(0.05) * next.to, next.to}"},
        LITTLE,
        ("B10",),
    ),
    _of(
        "far-side-shines",
        "the cosine at the lamp is taken without its sign, and the lamp blocks nothing",
        ("light-term", "light-radiance", "light-visible"),
        {
            "l.cosine_q = -dot(l.nq, l.to);": "l.cosine_q = std::fabs(dot(l.nq, l.to));",
            "!seen.paint || seen.t": "!seen.paint || seen.paint == &BULB || seen.t",
        },
        LITTLE,
        ("E06", "D08"),
    ),
)
