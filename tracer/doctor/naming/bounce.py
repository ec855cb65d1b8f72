"""What breaks the laws of bounces and roulette."""

import numpy as np

from tracer.doctor.naming.case import SHARE, Clue, first
from tracer.doctor.naming.reflection import exchanged, given_to, local, to_the_lamp, wrong_f
from tracer.frame import dot

_ZERO = "the density of this direction is 0, and the path goes on: the throughput is 0/0"


def _divided_by_zero(case):
    """Whether paths go on in directions of density 0."""
    return bool(np.mean(case["pdf"] == 0.0) >= SHARE)


def density(case):
    """The density of a bounce."""
    given, wi = given_to(case), case["wi"]
    cos, right = np.abs(dot(given["n"], wi)), case.right
    one = np.ones_like(right)

    def masked():
        g1 = case.evidence.trace.column("bounce", "G1")
        return False if g1 is None else right / g1[case.rows]

    return first(
        case,
        [
            ("B15", _ZERO, _divided_by_zero(case)),
            (
                "B01",
                "recorded 1/(2 pi), the density of uniform directions; the sampler declared has cos/pi",
                one * 0.5 / np.pi,
            ),
            (
                "B01",
                "recorded cos/pi, the density of cosine-weighted directions; the sampler declared is uniform",
                cos / np.pi,
            ),
            ("B08", "recorded 1/(4 pi): the density over the whole sphere", one * 0.25 / np.pi),
            (
                "W02",
                "recorded = pdf(wo | wi): the density of the opposite way",
                lambda: exchanged(case.evidence, given, wi, "pdf"),
            ),
            (
                "W04",
                "recorded is the density asked with world directions as if they were local",
                lambda: local(case.evidence, given, wi, "pdf"),
            ),
            ("S07", "recorded = right / G1: the density of visible normals lacks their masking", masked),
            (
                None,
                "recorded is the density of the light sample's direction, not of the bounce's",
                lambda: to_the_lamp(case, given, "pdf"),
            ),
            (None, "recorded = right x pi", right * np.pi),
            (None, "recorded = right / pi", right / np.pi),
            (None, "recorded = right / cos", right / cos),
            (None, "recorded 1", one),
        ],
    )


def reflected(case):
    """f of a bounce."""
    zero = ("B15", _ZERO, _divided_by_zero(case))
    return first(case, [zero, *wrong_f(case, given_to(case), case["wi"])])


def cosine(case):
    """The cosine at a bounce, or at a light sample."""
    n, wo = case.vertex("n"), case.vertex("wo")
    return first(
        case,
        [
            (None, "recorded = n . wo: the cosine of the way that the path came", np.abs(dot(n, wo))),
            (None, "recorded 1: there is no cosine", np.ones_like(case.right)),
        ],
    )


def throughput(case):
    """beta after a bounce."""
    before, f, pdf = case["beta_before"] if case.has("beta_before") else np.nan, case["f"], case["pdf"]
    cos, right = np.where(case["delta"], 1.0, case["cos"]), case.right
    q = case.evidence.settings.roulette
    q = float(q) if q not in ("auto", "off") else 1.0
    return first(
        case,
        [
            ("B02", "recorded = beta f cos: the density is forgotten", right * pdf),
            ("B12", "recorded = beta: f cos / pdf is not multiplied", before * np.ones_like(right)),
            ("B12", "recorded = beta cos / pdf: f is forgotten", before * cos / pdf),
            ("D10", "recorded = right / cos: the cosine is missing", right / cos),
            ("D10", "recorded = right x cos: there is one cosine too many", right * cos),
            ("B03", "recorded = right x pi: 1/pi is missing", right * np.pi),
            (None, "recorded = right / pi: 1/pi is there twice", right / np.pi),
            (None, "recorded = right x 2", right * 2.0),
            (None, "recorded = right / 2", right / 2.0),
            (None, "recorded = right / q: paid for the roulette here already", right / q),
            (None, "recorded = right x q", right * q),
            (None, "recorded = f cos / pdf: what the path carried is forgotten", f * cos / pdf),
        ],
    )


def on_arrival(case):
    """beta at the next vertex."""
    q = case.evidence.settings.roulette
    q = float(q) if q not in ("auto", "off") else np.nan
    return first(
        case,
        [
            (None, "recorded = right / q: the roulette is paid for twice", case.right / q),
            ("A01", "what fills the way takes nothing of the throughput", case.right / case["transmittance"]),
            (None, "recorded = 1: the throughput starts afresh", np.ones_like(case.right)),
        ],
    )


def survivors(case):
    """beta of roulette's survivors."""
    q, right = case["probability"], case.right
    return first(
        case,
        [
            ("R01", "recorded = beta: the survivors do not stand in for the dead", right * q),
            (None, "recorded = beta / q^2: divided twice", right / q),
            (None, "recorded = beta q: multiplied where it must be divided", right * q * q),
            (None, "recorded = beta / (1 - q)", right * q / (1.0 - q)),
        ],
    )


def chance(case):
    """The probability of surviving."""
    ends = np.isin(case.recorded, (0.0, 1.0))
    q = case.recorded
    if ends.mean() >= SHARE and (q == 0.0).any():
        depth = int(case.depth[q == 0.0].min())
        return Clue("R05", f"recorded 0 from depth {depth} on: a cut, which nothing makes up for")
    several = np.unique(case.depth).size > 1
    if several and np.ptp(q) < 1e-6 and q[0] < 0.5 * case.right.min():
        return Clue(
            "R06",
            f"recorded {q[0]:.3g} everywhere, where {case.right.min():.3g} and more is declared: of "
            f"{1 / q[0]:.0f} paths one goes on",
        )
    return None


def survival(case):
    """Who goes on."""
    return first(
        case,
        [
            (
                "R03",
                "who draws less than q dies, who draws more goes on: the test is reversed",
                1.0 - case.right,
            )
        ],
    )


def mirror(case):
    """Directions of Dirac lobes."""
    n, wo, wi = case.vertex("n"), case.vertex("wo"), case["wi"]
    cos_i, cos_t = np.abs(dot(n, wo)), np.abs(dot(n, wi))
    sin_i, sin_t = np.sqrt(np.maximum(1 - cos_i**2, 0)), np.sqrt(np.maximum(1 - cos_t**2, 0))
    eta = case.evidence.trace.column("bounce", "eta")
    if eta is None:
        return None
    eta = eta[case.rows].astype(float)
    with np.errstate(all="ignore"):
        bent = sin_i / sin_t  # what Snell's law was used with
    use = np.isfinite(bent) & (sin_i > 0.05)
    if use.any() and np.mean(np.abs(bent - 1 / eta)[use] < 1e-3 / eta[use]) >= SHARE:
        inside = np.mean(dot(case.evidence.brute.normals(case.vertex("p"), case.vertex("primitive")), wo) < 0)
        if inside >= SHARE:
            return Clue(
                "S01", "sin i / sin t is the inverse of the index, from inside: it is not swapped there"
            )
        return Clue(
            "W03", "sin i / sin t is the inverse of the index, from both sides: inside is taken for outside"
        )
    if case.is_(wo):
        return Clue("S04", "what is reflected goes back along wo: the half vector has the wrong sign")
    if np.mean(~np.isfinite(case.right).all(axis=0)) >= SHARE:
        return Clue("S02", "light is transmitted where all of it is reflected")
    return None


def mirror_share(case):
    """f of Dirac lobes."""
    eta = case.evidence.trace.column("bounce", "eta")
    if eta is None:
        return None
    eta = eta[case.rows].astype(float)
    return first(
        case,
        [
            (
                "S06",
                "recorded = right x eta^2: radiance that enters is not scaled by the square of the index",
                case.right * eta * eta,
            ),
            ("S06", "recorded = right / eta^2: scaled twice", case.right / (eta * eta)),
        ],
    )


def side(case):
    """Bounces into the surface."""
    if _divided_by_zero(case):
        return Clue("B15", _ZERO)
    share = case.outcome.wrong.sum() / max((~case.outcome.unsure).sum(), 1)
    if 0.4 < share < 0.6:
        return Clue(
            "B08", f"{share:.0%} of the directions lead into the surface: the whole sphere is sampled"
        )
    return None


NAMES = {
    "bounce-pdf": density,
    "bounce-f": reflected,
    "bounce-cos": cosine,
    "light-cos": cosine,
    "throughput": throughput,
    "throughput-on-arrival": on_arrival,
    "roulette-weight": survivors,
    "roulette-probability": chance,
    "roulette-survival": survival,
    "bounce-mirror": mirror,
    "bounce-mirror-f": mirror_share,
    "bounce-side": side,
}
