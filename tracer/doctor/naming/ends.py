"""What breaks the laws of a path's beginning and end, and of what it brings to its pixel."""

import numpy as np

from tracer.doctor.naming.case import SHARE, Clue, first
from tracer.events import END_REASONS
from tracer.frame import dot


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


def absorbed(case):
    """Paths that end on a diffuse surface."""
    ends = case.evidence("end.reason")
    share = case.outcome.wrong.sum() / ends.size
    unsaid = "roulette" in case.evidence.trace.free and case.evidence.count("roulette") == 0
    if case.evidence.count("bounce") == 0 and unsaid:
        return Clue(
            None,
            "no path goes on after its first surface, nor is roulette played there: "
            "indirect light is missing",
        )
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
    depth, going = case.depth, case.evidence.trace.tables["bounce"].depth
    if np.unique(depth).size == 1 and depth[0] > going.max():
        words = f"all paths that come as far end at depth {depth[0]}: a cut, which nothing makes up for"
        return Clue("R05", words)
    ends = case.outcome.wrong.sum()
    if 0.4 < ends / (ends + n.shape[1]) < 0.6:
        return Clue("B08", "half of the directions lead into the surface: the whole sphere is sampled")
    return None


def light_due(case):
    """Vertices without a light sample."""
    lamp = case.evidence.scene.light_of.take(case["primitive"]) >= 0
    if lamp.all():
        return Clue(None, "only where lamps are met, which reflect light as other surfaces do")
    return None


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


_UNFOUNDED = {
    "invalid": "paths are dropped as invalid, though each number of theirs is finite",
    "roulette": "paths end by roulette, though none was lost just before",
    "max_depth": "paths end as the deepest that may be, though they are not so deep",
    "escaped": "paths end as escaped, though something is met",
    "black": "paths end as at a black surface, though it reflects light",
}


def end(case):
    """Paths that end for no reason."""
    reasons = np.asarray(END_REASONS)[case.evidence("end.reason")[case.rows]]
    for reason, words in _UNFOUNDED.items():
        if (reasons == reason).mean() >= SHARE:
            return Clue(None, words)
    return None


NAMES = {
    "end": end,
    "camera-ray": camera_ray,
    "absorbed": absorbed,
    "light-due": light_due,
    "ledger": ledger,
}
