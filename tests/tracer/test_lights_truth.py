"""Lamps sampled by area, and the variance of every way to find them, against what is known exactly.

Each estimate is allowed 4 standard errors, which are at most 1 %; one in 16 000 is further off by chance.
Float32 is allowed 1e-5 on top. The other exact values are in test_truth.
"""

import lamps
import pytest
from lamps import MEANS, VARIANCES, radiance_samples, variance_and_error
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
