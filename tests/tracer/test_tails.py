"""Our tails of distributions against SciPy's."""

import numpy as np
import pytest
from scipy import stats

from tracer import tails


def test_the_normal_tail():
    z = np.linspace(-35.0, 35.0, 1001)
    np.testing.assert_allclose(tails.normal_p(z), 2.0 * stats.norm.sf(np.abs(z)), rtol=1e-12)
    assert np.isnan(tails.normal_p(np.nan)) and tails.normal_p(np.inf) == 0.0
    for p in (1.0, 0.05, 1e-10, 1e-300):
        assert tails.normal_z(p) == pytest.approx(stats.norm.isf(0.5 * p), rel=1e-9)


@pytest.mark.parametrize(
    ("freedom", "most"),
    [(1, 0.18), (2, 0.009), (5, 2e-4), (10.5, 4e-6), (30, 1e-7), (1e6, 1e-9), (np.inf, 1e-9)],
)
def test_students_tail(freedom, most):
    t = np.linspace(-12.0, 12.0, 2001)
    exact = np.sign(t) * stats.norm.isf(np.maximum(stats.t.sf(np.abs(t), freedom), 1e-300))
    near = np.abs(exact) < 8.0
    assert np.abs(tails.student_z(t, freedom) - exact)[near].max() < most


@pytest.mark.parametrize("freedom", [50, 1000, 10**6])
@pytest.mark.parametrize("p", [0.9, 0.5, 0.01, 1e-4])
def test_the_chi_square_tail(freedom, p):
    z = tails.chi_square_z(stats.chi2.isf(p, freedom), freedom)
    assert stats.norm.sf(z) == pytest.approx(p, rel=0.05)


@pytest.mark.parametrize("n", [50, 5000])
@pytest.mark.parametrize("scale", [1.0, 1.1])
def test_kolmogorov_and_smirnov(suite_seed, n, scale):
    z = scale * np.random.default_rng(suite_seed).normal(size=n)
    assert tails.kolmogorov_p(z) == pytest.approx(stats.kstest(z, "norm").pvalue, abs=0.02)


def test_sidak_there_and_back():
    for tests in (1, 10, 10**6):
        assert tails.together(tails.shared(0.01, tests), tests) == pytest.approx(0.01)
    assert tails.together(0.0, 5) == 0.0 and tails.together(1.0, 5) == 1.0
