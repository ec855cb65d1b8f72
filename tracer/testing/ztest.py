"""The z-test of two pictures.

Null hypothesis: every pixel of both has the same expectation; samples are independent, or where they are not,
the replicates that take their place (Settings.replicates). Three tests share the significance alpha (Sidak
1967): every pixel and channel by its z; the whole picture's bias Z, which sees a uniform bias about sqrt(P)
times smaller; and the pixels that did not vary at all and yet differ.

What decides is built not to cry wolf where noise is skewed, as that of path tracing is: a pixel that by
chance missed its rare bright paths is too dark *and* thinks itself too sure. So a pixel's error is the
largest of four estimates (its own, both pictures' samples together, its neighbours', the other picture's),
and the bias Z weighs a pixel by its neighbours' errors, never by its own. `shape` describes the plain z and
decides nothing.
"""

import math
from dataclasses import dataclass, field

import numpy as np

from tracer import tails
from tracer.settings import TracerError
from tracer.testing.errorbars import parts_of, why_unknown
from tracer.testing.errors import ROUNDING
from tracer.testing.regions import SMALLEST, around, local_Z, mean, weighed_bias, worst_region

ALPHA = 0.01  # chance that two right pictures are called different
CERTAIN = 40.0  # z of what cannot be chance: no float64 is as small as its tail


@dataclass(frozen=True)
class Estimate:
    """A picture as statistics see it, in float64. From a float or plain array: an exact truth."""

    mean: np.ndarray  # (H, W, 3)
    variance: np.ndarray  # (H, W, 3) of the mean; NaN where not known
    samples: np.ndarray  # (H, W, 1) that are independent, or replicates; infinite where exact or not known
    size: np.ndarray | float = 1.0  # (H, W, 1) samples in each of these

    @classmethod
    def of(cls, picture, shape=None):
        """From what has .rgb, .variance and .samples; or numbers without error, spread to `shape`."""
        rgb = getattr(picture, "rgb", None)
        if rgb is None:
            mean = np.broadcast_to(
                np.asarray(picture, np.float64), np.shape(picture) if shape is None else shape
            )
            return cls(mean, np.zeros(mean.shape), np.full((*mean.shape[:2], 1), np.inf))
        if why_unknown(picture):
            raise TracerError(f"a picture without variance gives no p-value: {why_unknown(picture)}")
        samples = np.inf if picture.samples is None else picture.samples
        samples = np.broadcast_to(np.asarray(samples, np.float64), rgb.shape[:2])[..., None]
        independent = samples if parts_of(picture) is None else np.minimum(samples, parts_of(picture))
        size = np.where(np.isfinite(samples), samples / np.maximum(independent, 1.0), 1.0)
        return cls(rgb.astype(np.float64), picture.variance.astype(np.float64), independent, size)


@dataclass(frozen=True)
class Comparison:
    """What a z-test of two pictures found. Channels are tested one by one; x, y are from top left."""

    z: np.ndarray  # (H, W, 3) a - b in standard errors, as a normal number; NaN where nothing could be tested
    p: np.ndarray  # (H, W, 3) p-value, corrected for the number of tests; 1 where nothing could be tested
    tested: int  # pixels times channels
    Z: np.ndarray  # (3,) bias of the whole picture in its standard errors
    bias: np.ndarray  # (3,) mean of a - b, each pixel weighed by 1 / the standard error of its neighbours
    bound: np.ndarray  # (3,) 3 standard errors of that mean
    p_bias: float  # of the largest |Z|, corrected for 3 channels
    p_constant: float  # of the pixels that do not vary and yet differ, corrected for 3 channels
    shape: dict = field(repr=False)  # sum_z (3,) = sum z / sqrt(P), chi2_p (3,), ks_p (3,) of the plain z
    local_Z: np.ndarray = field(repr=False)  # (H, W, 3) Z of the 9 x 9 pixels around each
    region: tuple  # (x0, y0, x1, y1), exclusive, of the worst of 8 x 8 regions
    region_Z: float  # its largest |Z| over the channels, with sign
    invalid: int  # pixels that are not finite in one picture, or differently so
    unknown: int  # pixels whose variance is not known
    alpha: float

    @property
    def p_pixel(self):
        """p-value of the worst pixel, corrected for all of them."""
        return float(self.p.min(initial=1.0))

    @property
    def p_value(self):
        """Chance that two right pictures differ as much in any of the three ways."""
        return float(tails.together(min(self.p_pixel, self.p_bias, self.p_constant), 3))

    @property
    def same(self):
        """Whether noise alone explains the difference."""
        return not self.invalid and self.p_value >= self.alpha

    @property
    def worst(self):
        """x, y, channel of the pixel with the largest |z|."""
        return _largest(self.z)

    @property
    def centre(self):
        """x, y, channel of the pixel whose surroundings are furthest off."""
        return _largest(self.local_Z)


def z_test(a, b, alpha=ALPHA, rounding=ROUNDING):
    """Compare two pictures, or a picture with a truth: a Comparison.

    a, b: anything with .rgb (H, W, 3), .variance (of the mean) and .samples, as tracer.render and tracer.read
    give it; b may be a number or an array (H, W, 3) without error. The pictures must have been made from
    independent samples: from different seeds. Raises TracerError where sizes differ or variance is missing.
    """
    a = Estimate.of(a)
    b = Estimate.of(b, None if np.ndim(getattr(b, "rgb", b)) == 3 else a.mean.shape)
    if a.mean.shape != b.mean.shape:
        raise TracerError(f"sizes differ: {_size(a.mean)} and {_size(b.mean)}")
    with np.errstate(all="ignore"):
        return _compare(a, b, alpha, rounding)


def _compare(a, b, alpha, rounding):
    difference = a.mean - b.mean
    finite = np.isfinite(a.mean) & np.isfinite(b.mean)
    alike = (a.mean == b.mean) | (np.isnan(a.mean) & np.isnan(b.mean))
    known = finite & np.isfinite(a.variance) & np.isfinite(b.variance)
    size = np.maximum(np.abs(a.mean), np.abs(b.mean))
    still = known & _still(a, rounding * size) & _still(b, rounding * size)
    noisy = known & ~still
    plain, freedom = _welch(a, b, noisy)
    sure = _sure(a, b, noisy, plain)
    differ = still & (np.abs(difference) > rounding * size)
    chance = _chance_of_two_values(a.samples, b.samples)

    z = np.where(known, 0.0, np.nan)
    z[noisy] = tails.student_z((difference / np.sqrt(sure))[noisy], freedom[noisy])
    z[differ] = (np.sign(difference) * _z_of(chance))[differ]
    tested = int(noisy.sum() + still.sum())
    p = np.where(known, tails.together(tails.normal_p(z), tested), 1.0)
    weights = np.where(noisy, 1.0 / np.sqrt(around(plain, noisy)), 0.0)
    Z, bias, bound = weighed_bias(difference, plain, weights, known)
    region, region_Z = worst_region(difference, plain, weights, z)
    return Comparison(
        z=z,
        p=p,
        tested=tested,
        Z=Z,
        bias=bias,
        bound=bound,
        p_bias=float(tails.together(tails.normal_p(Z).min(), 3)),
        p_constant=_p_constant(still, differ, chance),
        shape=_shape(plain_z(a, b, noisy), noisy),
        local_Z=local_Z(difference, plain, weights),
        region=region,
        region_Z=region_Z,
        invalid=int((~finite & ~alike).any(axis=2).sum()),
        unknown=int((finite & ~known).any(axis=2).sum()),
        alpha=alpha,
    )


def _size(picture):
    return f"{picture.shape[1]} x {picture.shape[0]}"


def _largest(values):
    size = np.nan_to_num(np.abs(values), nan=-1.0)
    y, x, channel = np.unravel_index(np.argmax(size), size.shape)
    return int(x), int(y), int(channel)


def _still(estimate, rounding):
    """Where the samples vary by no more than rounding; standard deviation of one sample if n is known."""
    n = np.where(np.isfinite(estimate.samples), estimate.samples, 1.0)
    return estimate.variance * n <= rounding * rounding


def _welch(a, b, noisy):
    """Variance of a - b and its degrees of freedom (Welch 1947)."""
    free_a, free_b = np.maximum(a.samples - 1.0, 1.0), np.maximum(b.samples - 1.0, 1.0)
    plain = np.where(noisy, a.variance + b.variance, np.nan)
    # Shares, not squares: variances may be as small as float32 goes.
    return plain, 1.0 / ((a.variance / plain) ** 2 / free_a + (b.variance / plain) ** 2 / free_b)


def plain_z(a, b, noisy):
    """z (H, W, 3) of each pixel of two Estimates by its own variance and Student's tail."""
    plain, freedom = _welch(a, b, noisy)
    return tails.student_z((a.mean - b.mean) / np.sqrt(plain), freedom)


def _sure(a, b, noisy, plain):
    """The variance to judge a pixel by.

    Never below what both pictures' samples together say, nor the neighbours, nor what the less noisy picture
    says of the other: its variance around the pixel, times the ratio that the two have in the whole picture.
    """
    rough, fine = (a, b) if mean(a.variance, noisy).sum() > mean(b.variance, noisy).sum() else (b, a)
    smooth = around(fine.variance, noisy)
    ratio = mean(rough.variance / smooth, noisy & (smooth > SMALLEST))
    other = ratio * smooth + fine.variance
    return np.fmax.reduce((plain, _pooled(a, b), other, around(plain, noisy)))


def _pooled(a, b):
    """Variance of a - b from the samples of both as of one kind (Student 1908); 0 if they are not, or n is
    unknown."""
    both = np.isfinite(a.samples) & np.isfinite(b.samples) & (a.size == b.size)
    n, m = np.where(both, a.samples, 1.0), np.where(both, b.samples, 1.0)
    spread = a.variance * n * (n - 1.0) + b.variance * m * (m - 1.0)
    return np.where(both, spread / np.maximum(n + m - 2.0, 1.0) * (1.0 / n + 1.0 / m), 0.0)


def _chance_of_two_values(n, m):
    """(H, W, 1) largest probability that n samples are all alike, m too, and the two values differ.

    2 c^n (1 - c)^m at its largest, c = n / (n + m): the edge of a lamp can do that to a pixel of few samples.
    0 where one is exact.
    """
    c = n / (n + m)
    known = np.isfinite(n) & np.isfinite(m)
    return np.where(known, np.minimum(2.0 * np.exp(n * np.log(c) + m * np.log1p(-c)), 1.0), 0.0)


def _z_of(chance):
    """normal_z of few different chances, kept below CERTAIN."""
    values, places = np.unique(chance, return_inverse=True)
    z = np.array([tails.normal_z(p) if p > 1e-300 else CERTAIN for p in values])
    return np.minimum(z, CERTAIN)[places].reshape(chance.shape)


def _p_constant(still, differ, chance):
    """p-value of so many constant pixels that differ: a bound of the binomial tail (Hoeffding 1963)."""
    p, lowest = float(chance.max(initial=0.0)), 1.0
    for n, k in zip(still.sum(axis=(0, 1)), differ.sum(axis=(0, 1)), strict=True):
        share = k / max(n, 1)
        if share > p:
            surprise = share * math.log(share / max(p, SMALLEST))
            surprise += (1.0 - share) * (math.log((1.0 - share) / (1.0 - p)) if share < 1.0 else 0.0)
            lowest = min(lowest, math.exp(-n * surprise))
    return float(tails.together(lowest, 3))


def _shape(z, noisy):
    """How the plain z of each channel are distributed: sum, p-values of the sum of squares and of KS."""
    shape = {"sum_z": [], "chi2_p": [], "ks_p": []}
    for channel in range(z.shape[2]):
        values = z[..., channel][noisy[..., channel]]
        n = max(values.size, 1)
        upper = 0.5 * math.erfc(tails.chi_square_z(float((values**2).sum()), n) / math.sqrt(2.0))
        shape["sum_z"].append(float(values.sum() / math.sqrt(n)))
        shape["chi2_p"].append(2.0 * min(upper, 1.0 - upper) if values.size else 1.0)
        shape["ks_p"].append(tails.kolmogorov_p(values) if values.size else 1.0)
    return shape
