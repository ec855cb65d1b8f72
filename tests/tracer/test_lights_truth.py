"""Lamps sampled by area, and the variance of every way to find them, against what is known exactly.

Each estimate is allowed 4 standard errors, which are at most 1 %; one in 16 000 is further off by chance.
Float32 is allowed 1e-5 on top. The other exact values are in test_truth.
"""

import lamps
import pytest
from lamps import radiance_samples, variance_and_error
from truth import entry, keys
from values.lights import from_rectangle

RECTANGLES = [key for key in keys("rect.") if key != "rect.edge_on" and "touching" not in key]
SLACK = {32: 1e-5, 64: 0.0}


@pytest.mark.slow
@pytest.mark.statistical
@pytest.mark.parametrize("precision", [32, 64])
@pytest.mark.parametrize("key", RECTANGLES)
def test_a_rectangle_sampled_by_area_sends_what_lambert_says(suite_seed, key, precision):
    given, value = entry(key)
    found = from_rectangle(key, given, precision, suite_seed, 1_600_000, by="area")
    assert lamps.close(found, value, slack=SLACK[precision])


# Variance per sample (accuracy.md 2.6), by strategy, light sampling and heuristic; `mis` spends two samples.
VARIANCES = {
    ("small", "light", "area"): 1.34122e-05,
    ("small", "light", "solid_angle"): 8.373657719e-07,
    ("small", "bsdf", "area"): 0.0680787,
    ("small", "mis", "area"): 1.500289538e-05,
    ("small", "mis", "solid_angle"): 2.777072650e-06,
    ("offset", "light", "area"): 4.06475e-05,
    ("offset", "light", "solid_angle"): 2.352293274e-06,
    ("offset", "bsdf", "area"): 0.0137298475,
    ("offset", "mis", "area"): 4.05805e-05,
    ("offset", "mis", "solid_angle"): 2.35017e-06,
    ("near", "light", "area"): 5.88455,
    ("near", "light", "solid_angle"): 0.124254,
    ("near", "bsdf", "area"): 0.0462163,
    ("near", "mis", "area"): 0.146387,
    ("near", "mis", "solid_angle"): 0.0390851,
    ("touching", "light", "solid_angle"): 0.3043374198,
    ("touching", "bsdf", "area"): 0.000510912,
    ("touching", "mis", "area"): 0.0234224,
    ("touching", "mis", "solid_angle"): 0.0501374,
}
MEANS = {"small": 0.0734776, "offset": 0.0139237, "near": 0.951424, "touching": 0.999489}


@pytest.mark.slow
@pytest.mark.statistical
@pytest.mark.parametrize(("name", "strategy", "by"), VARIANCES)
def test_s18_the_variance_is_the_one_known(suite_seed, name, strategy, by):
    """Within 5 %, which is at least 4 standard errors of the variance."""
    rare = (name, strategy) == ("touching", "bsdf")  # a bounce in 2000 misses the lamp
    spp = 1 << (21 if rare else 18)
    samples = radiance_samples(suite_seed, lamps.room(name), strategy, by, spp)
    variance, error = variance_and_error(samples)
    known = VARIANCES[name, strategy, by]
    print(f"{name} {strategy} {by}: {variance / known - 1:+.4f} +- {error:.4f}")
    assert abs(variance / known - 1) <= max(0.05, 4 * error) and error < 0.03
    assert lamps.close(samples, MEANS[name], bar=0.1, slack=1e-5)


@pytest.mark.statistical
@pytest.mark.parametrize("name", ["small", "near"])
def test_solid_angle_sampling_has_the_variance_known(suite_seed, name):
    """The quick one of the table above: within 5 %, at least 4 standard errors."""
    for strategy in ("light", "mis"):
        variance, error = variance_and_error(
            radiance_samples(suite_seed, lamps.room(name), strategy, "solid_angle", 1 << 16)
        )
        assert abs(variance / VARIANCES[name, strategy, "solid_angle"] - 1) <= 0.05 and 4 * error <= 0.05
    variance, _ = variance_and_error(radiance_samples(suite_seed, lamps.room(name), "light", "area", 1 << 16))
    assert abs(variance / VARIANCES[name, "light", "solid_angle"] - 1) > 0.05  # the broken twin
