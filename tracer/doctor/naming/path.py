"""What breaks the laws of emission, of the way from vertex to vertex, of normals, and of the sum."""

import numpy as np

from tracer.doctor.laws.emission import mis
from tracer.doctor.naming.case import SHARE, Clue, first
from tracer.frame import dot, length


def weight(case):
    """The weight of a lamp that is met."""
    settings, recorded = case.evidence.settings, case.recorded
    pdf_bsdf = case["pdf_bsdf"] if case.has("pdf_bsdf") else np.full(recorded.shape, np.nan)
    pdf_light = case["pdf_light"]
    twice = bool(((recorded == 1.0) & (case.right < 1.0)).mean() >= SHARE)
    never = bool(((recorded == 0.0) & (case.right == 1.0)).mean() >= SHARE)
    depths = ", ".join(map(str, np.unique(case.depth)))
    outcome = case.outcome
    # Of lamps that are met alike, some only: then it is not the rule that is wrong.
    alike = outcome.right < 1.0 if twice else outcome.right == 1.0
    everywhere = bool(outcome.wrong[alike].mean() >= SHARE)
    return first(
        case,
        [
            (
                ("E01", "E04"),
                "recorded 1 at lamps that light samples counted at the vertex before: counted twice",
                twice and everywhere,
            ),
            (
                None,
                f"recorded 1 at depth {depths}, at lamps that light samples counted at the vertex before",
                twice,
            ),
            (
                "E02",
                "recorded 0 at lamps that nothing else can count: their own light is lost",
                never and everywhere,
            ),
            (
                None,
                f"recorded 0 at some lamps that nothing else can count, at depth {depths}",
                never,
            ),
            (
                "M02",
                "recorded = MIS(1, pdf_light) after the camera or a mirror, which no light sample does",
                lambda: _of_dirac(case, pdf_bsdf, mis(settings, np.ones_like(pdf_light), pdf_light)),
            ),
            ("M01", "recorded is the weight of the other technique", mis(settings, pdf_light, pdf_bsdf)),
        ],
    ) or Clue("M01", "the weights of this light found both ways do not sum to 1")


def _of_dirac(case, pdf_bsdf, predicted):
    return bool(np.isinf(pdf_bsdf).mean() >= SHARE) and predicted


def emission(case):
    """Le of a vertex."""
    nothing = (case.recorded == 0.0).all(axis=0) & (case.right > 0.0).any(axis=0)
    n = case.evidence.brute.normals(case["p"], case["primitive"])
    back = (dot(n, case["wo"]) < 0.0) & (case.recorded > 0.0).any(axis=0)
    return first(
        case,
        [
            (
                "E03",
                "recorded 0 on a lamp's bright side: its emission is read from where it was never put",
                bool(nothing.mean() >= SHARE),
            ),
            ("E06", "the lamp shines from its back", bool(back.mean() >= SHARE)),
        ],
    )


def on_surface(case):
    """Vertices that do not lie on their surfaces."""
    scene = case.evidence.scene
    names = sorted({scene.shapes[k].name for k in np.unique(scene.shape_of.take(case["primitive"]))})
    return Clue(None, f"on {', '.join(names)}, by up to {case.recorded.max():.2g}")


def chain(case):
    """Vertices beside their rays."""
    evidence, rows = case.evidence, case.rows
    o, d, source = (column[..., rows] for column in evidence.arrivals)
    taken = case.recorded
    behind = dot(taken, d) < -0.999
    if behind.mean() >= SHARE:
        return Clue("G02", "the next vertex lies behind the start of the ray: t < 0 counts as a hit")
    vertex = evidence.before("hit", "hit")[rows]
    later = vertex >= 0
    if later.mean() < SHARE:
        return None
    n, p, primitive = (evidence(f"hit.{name}")[..., vertex[later]] for name in ("n", "p", "primitive"))
    local = evidence.scene.frame(n, p, primitive).to_local(d[:, later])
    off = length(local - taken[:, later])
    if np.mean(off < 0.01) >= SHARE:
        return Clue("B05", "the ray goes along the local coordinates of wi, as if they were the world's")
    return None


def first_surface(case):
    """Vertices behind the first surface."""
    evidence, rows = case.evidence, case.rows
    along = case.recorded
    t = evidence("hit.t")[rows] if evidence.has("hit.t") else along
    skipped = (along - t) / case.right
    if np.mean(np.abs(skipped - 1.0) < 0.01) >= SHARE:
        return Clue(
            "B10",
            "t is measured from the surface that was skipped: the path goes on from the next hit's point, in "
            "the old direction",
        )
    return _never_met(case)


def _never_met(case):
    """The surfaces that rays go through are those that no ray of the trace meets at all."""
    evidence = case.evidence
    through = np.unique(case.outcome.facts["met"][case.outcome.wrong])
    flat = np.array([np.ptp(shape.outline(), axis=1).min() for shape in evidence.scene.shapes])
    primitive = evidence("hit.primitive")
    met = np.bincount(primitive[primitive >= 0], minlength=evidence.scene.shape_of.size)
    if met[through].any():
        return None
    names = ", ".join(sorted({evidence.scene.shapes[k].name for k in evidence.scene.shape_of[through]}))
    if (flat[evidence.scene.shape_of[through]] <= 1e-9 * evidence.scale).all():
        return Clue("G01", f"no ray meets {names}: their bounding boxes have no thickness, and are refused")
    return Clue(None, f"no ray meets {names}")


_OFTEN = 0.005  # share of the vertices that rays without any offset meet again, and more


def own_surface(case):
    """Rays that meet what they start on."""
    share = case.outcome.wrong.sum() / max(case.outcome.rows.size, 1)
    ball = case.evidence.brute.is_sphere.take(case["primitive"])
    words = f"{share:.2%} of the vertices lie on the surface that the ray starts on"
    if share < _OFTEN:
        return Clue(None, f"{words}: what keeps rays off it is not enough everywhere")
    words = f"{words}: it has no offset, no least t"
    if ball.mean() >= SHARE:
        return Clue("G08", words, ("G03",))
    return Clue("G03", words, ("G08",) if ball.any() else ())


def unit_direction(case):
    """Directions that are not unit."""
    if case.kind != "bounce" or case.outcome.facts["field"] != "wi":
        return None
    n, nan = case.vertex("n"), ~np.isfinite(case.recorded)
    if nan.mean() < SHARE:
        return None
    if case.has("delta") and case["delta"].all():
        eta = case.evidence.trace.column("bounce", "eta")
        cos = dot(n, case.vertex("wo"))
        if eta is not None and np.mean(1.0 - cos * cos >= eta[case.rows].astype(float) ** 2 - 1e-4) >= SHARE:
            return Clue("S02", "no number, where all light is reflected: the root of a negative number")
        return None
    along = np.abs(n).max(axis=0)
    axis = np.abs(n).argmax(axis=0)
    if (along > 1.0 - 1e-5).all() and np.unique(axis).size == 1:
        return Clue(
            "B17", f"no number wherever the normal is along {'xyz'[axis[0]]}: there the frame breaks down"
        )
    return None


def normal(case):
    """Normals that are not the surface's."""
    size = length(case.recorded)
    turned = dot(case.recorded, case.right) < -0.999 * size
    if (turned & (dot(case.recorded, case["wo"]) > 0.0)).mean() >= SHARE:
        return Clue(
            None, "recorded = -right wherever the back is seen: it is turned to where the ray comes from"
        )
    return first(
        case,
        [
            (
                "N01",
                "the normal is the zero vector: the mesh has none, and none was made",
                bool((size < 1e-6).mean() >= SHARE),
            ),
            (
                "N02",
                "recorded = -right: the winding is turned over",
                bool((turned & (size > 0.5)).mean() >= SHARE),
            ),
        ],
    )


def shading(case):
    """Shading normals that are not the interpolated ones."""
    clue = normal(case)
    if clue:
        return clue
    stretch = case.recorded / case.right
    big = (np.abs(case.right) > 0.1).all(axis=0)
    stretch = (stretch / stretch[:1])[:, big]
    if big.sum() > 8 and (np.ptp(stretch, axis=1) < 0.01).all() and np.abs(stretch - 1.0).max() > 0.01:
        x, y, z = (f"{v:.3g}" for v in np.median(stretch, axis=1))
        return Clue(
            "N03", f"x, y, z are stretched like {x} : {y} : {z}: moved by M, not its inverse transpose"
        )
    return None


_NEVER_UNIT = 1e-3  # farther from 1 no rounding brings a length


def unit_normal(case):
    """Normals whose length is not 1."""
    size, evidence = case.recorded, case.evidence
    if (size < 1e-6).mean() >= SHARE:
        return Clue("N01", "the normal is the zero vector")
    field = case.outcome.facts["field"]
    if (
        field == "n"
        and evidence.is_unit("hit.ng").all()
        and evidence.scene.has_smooth_normals
        and size.max() < 1.0
    ):
        return Clue(
            "N04", "only interpolated normals are too short: what lies between two unit vectors is shorter"
        )
    off = np.abs(size - 1.0)
    if not np.median(off) > _NEVER_UNIT:
        return Clue(None, f"lengths off by up to {off.max():.2g}")
    return Clue("B18", f"lengths from {size.min():.3g} to {size.max():.3g}: the normal was never made unit")


def ledger(case):
    """Radiance that is not the sum."""
    evidence, recorded, right = case.evidence, case.recorded, case.right
    spp = evidence.settings.spp
    zero = (recorded == 0.0).all(axis=0)
    y = evidence("path.y")[case.rows]
    rows_lost = zero.mean() >= SHARE and np.unique(y).size < 0.5 * np.unique(evidence("path.y")).size
    factor = np.median(recorded[right > 0.0] / right[right > 0.0]) if (right > 0.0).any() else np.nan
    guesses: list = [
        ("F01", "recorded = min(sum, 1): each sample is clamped", np.minimum(right, 1.0)),
        (
            "F03",
            "recorded = sum^(1/2.2): each sample is bent for the screen before the mean is taken",
            np.maximum(right, 0.0) ** (1 / 2.2),
        ),
        (
            "F03",
            "recorded = sum^0.6: each sample is bent for the screen before the mean is taken",
            np.maximum(right, 0.0) ** 0.6,
        ),
        ("F04", f"recorded = {spp} x sum: the pixel is not divided by its number of samples", right * spp),
        ("P06", "nothing is left in whole rows of the picture", bool(rows_lost)),
    ]
    cap = recorded.max()
    if (recorded == cap).mean() > 0.2 and (right.max(axis=0) >= cap).all():
        guesses.append(
            ("F01", f"recorded = min(sum, {cap:.3g}): each sample is clamped", np.minimum(right, cap))
        )
    if np.isfinite(factor):
        guesses.append((None, f"recorded = {factor:.4g} x sum", right * factor))
    return first(case, guesses)


def absorbed(case):
    """Paths that end on a diffuse surface."""
    ends = case.evidence("end.reason")
    share = case.outcome.wrong.sum() / ends.size
    if case.evidence.count("bounce") == 0:
        return Clue(
            "W01",
            f"{share:.0%} of the paths end at their first diffuse surface: the BSDF is asked with a "
            "direction that points into the surface, and answers 0",
        )
    wi, p = case.evidence("bounce.wi"), case.evidence.at_vertex("bounce", "p")
    n = case.evidence.at_vertex("bounce", "n")
    if (dot(wi, p) > 0.0).mean() >= 0.999 and (dot(n, p) > 0.0).mean() < 0.9:
        return Clue(
            "B04", "every bounce goes away from the origin of space: the position stands for the normal"
        )
    ends = case.outcome.wrong.sum()
    if 0.4 < ends / (ends + n.shape[1]) < 0.6:
        return Clue("B08", "half of the directions lead into the surface: the whole sphere is sampled")
    return None


def camera_ray(case):
    """Camera rays that miss their place on the film."""
    camera, settings = case.evidence.scene.camera, case.evidence.settings
    width, height = settings.width, settings.height
    d, (x, y) = case["d"], case["film"]
    ahead = dot(d, camera.forward[:, None])
    at_x, at_y = dot(d, camera.right[:, None]) / ahead, dot(d, camera.up[:, None]) / ahead
    half = np.tan(np.radians(0.5 * camera.fov_x))
    right_x, right_y = (2 * x / width - 1) * half, (1 - 2 * y / height) * half * height / width

    def same(a, b):
        return bool(np.mean(np.abs(a - b) < 1e-3 * half) >= SHARE)

    scale = np.median(at_x[np.abs(right_x) > 0.1 * half] / right_x[np.abs(right_x) > 0.1 * half])
    tall = np.median(at_y[np.abs(right_y) > 0.1 * half] / right_y[np.abs(right_y) > 0.1 * half])
    linear = same(at_x, scale * right_x) and same(at_y, tall * right_y)
    words = f"x is stretched by {scale:.3g} and y by {tall:.3g}"
    if linear and (scale < 0 or tall < 0):
        return Clue("F06", f"{words}: the picture is mirrored")
    if linear:
        return Clue("F06", f"{words}: aspect ratio or field of view")
    seen_x = 0.5 * (at_x / half + 1.0) * width
    seen_y = 0.5 * (height - at_y / half * width)
    off = np.stack((seen_x - x, seen_y - y))
    inside = (seen_x > -0.5) & (seen_x < width + 0.5) & (seen_y > -0.5) & (seen_y < height + 0.5)
    if inside.all() and np.mean(np.abs(off - off.round()) < 0.01) >= SHARE:
        return Clue("P05", "the rays are those of other pixels of the picture, by whole pixels")
    if inside.all():
        return Clue(None, "the rays are those of other places in the picture")
    return None


NAMES = {
    "emission-weight": weight,
    "environment-weight": weight,
    "emission": emission,
    "on-surface": on_surface,
    "chain": chain,
    "first-surface": first_surface,
    "normal": normal,
    "shading-normal": shading,
    "escape-free": _never_met,
    "own-surface": own_surface,
    "unit-direction": unit_direction,
    "unit-normal": unit_normal,
    "ledger": ledger,
    "absorbed": absorbed,
    "camera-ray": camera_ray,
}
