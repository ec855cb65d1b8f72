"""Fresnel's reflectances where they are delicate, and Schlick's approximation; values are in test_truth."""

import numpy as np
import pytest
from truth import ULPS, close, entry

import tracer
from tracer import Settings
from tracer.bsdf import Conductor, Dielectric, fresnel

ONES = np.ones((3, 1))
BOTH = pytest.mark.parametrize("dtype", [np.float32, np.float64])


def mean(cos, eta, formula="exact", dtype=np.float64):
    return fresnel.dielectric_mean(np.array([cos], dtype), np.array([eta], dtype), formula)[0][0]


@pytest.mark.slow
@pytest.mark.parametrize("n", [1.33, 1.5, 2.42])
def test_as_much_diffuse_light_gets_out_of_a_dielectric_as_in(n):
    out, back = (fresnel.diffuse_average(np.array([eta]))[0] for eta in (n, 1 / n))
    assert close(1 - back, (1 - out) / n**2)


def test_schlick_is_nowhere_further_off_than_is_said():
    p, value = entry("schlick.maxerr.n=2.42")
    cos, eta = np.linspace(0, 1, 2001), np.full(2001, p["n"])
    both = [fresnel.dielectric_mean(cos, eta, formula)[0] for formula in ("schlick", "exact")]
    assert np.abs(both[0] - both[1]).max() <= value * (1 + 1e-9)


def test_beyond_the_critical_angle_all_is_mirrored():
    for n in (1.33, 1.5, 2.42):
        critical = np.sqrt((n - 1) * (n + 1)) / n
        assert mean(critical - 1e-9, 1 / n) == 1 > mean(critical + 1e-9, 1 / n)


@pytest.mark.parametrize("n", [1.33, 1.5, 2.42])
def test_float32_keeps_its_digits_next_to_the_critical_angle(n):
    """Against float64 at the same inputs, an ulp of the cosine away from it."""
    eta = np.float32(1 / n)
    critical = np.float32(np.sqrt((1 - float(eta)) * (1 + float(eta))))
    cos = np.nextafter(critical, np.float32(1)) + np.arange(100, dtype=np.float32) * np.spacing(critical)
    got = fresnel.dielectric(cos, eta)
    want = fresnel.dielectric(cos.astype(float), float(eta))
    for a, b in zip(got, want, strict=True):
        assert a.dtype == np.float32 and (np.abs(a - b) <= 0.51 * np.spacing(b.astype(np.float32))).all()


@BOTH
def test_s28_index_1_reflects_nothing_at_any_angle(dtype):
    cos = np.array([1, 0.5, 1e-3, 1e-8, 0], dtype)
    for formula in ("exact", "schlick"):
        R, cos_t = fresnel.dielectric_mean(cos, np.ones(5, dtype), formula)
        assert np.array_equal(cos_t, cos)
        assert not R[:4].any() or formula == "schlick"  # Schlick's curve ends in 1 whatever the index


@pytest.mark.parametrize(("cos", "R"), [(1.0, 2.5e-15), (0.5, 2.5e-14), (1e-3, 2.0746933735e-3)])
def test_s29_an_index_next_to_1(cos, R):
    eta = 1 + 1e-7
    exact = {1.0: 2.5e-15, 0.5: 2.5e-14}
    got = mean(cos, eta)
    assert close(got, R, 2e-6 if cos in exact else 1e-9)  # to the digits of the reference
    # To rounding, against the same formula with 60 digits.
    assert close(got, by_decimals(cos, eta), 1e-12 + 4 * np.finfo(float).eps * 1e0 / cos)
    # In float32 the contrast itself is what the index was rounded to.
    single = np.float32(1 + 2.0**-23)
    want = by_decimals(float(np.float32(cos)), float(single))
    assert close(mean(cos, single, dtype=np.float32), want, 8 * np.finfo(np.float32).eps)


def by_decimals(cos, eta):
    """(Rs + Rp)/2 as printed in books, with 60 digits."""
    from decimal import Decimal, localcontext

    with localcontext() as context:
        context.prec = 60
        c, n = Decimal(cos), Decimal(eta)
        t = (1 - (1 - c * c) / (n * n)).sqrt()
        rs, rp = (c - n * t) / (c + n * t), (n * c - t) / (n * c + t)
        return float((rs * rs + rp * rp) / 2)


@BOTH
@pytest.mark.parametrize("eta", [1.5, 1 / 1.5, 2.4, 1.0001])
def test_s32_grazing_reflectance_rises_to_exactly_1(eta, dtype):
    cos = np.array([1e-1, 1e-2, 1e-3, 1e-6, 1e-8, 0], dtype)
    R, cos_t = fresnel.dielectric_mean(cos, np.full(6, eta, dtype))
    assert (np.diff(R) >= 0).all() and R[-1] == 1 and np.isfinite(cos_t).all()
    wo = np.stack((np.sqrt(1 - cos * cos), 0 * cos, cos))
    sample = Dielectric(np.array([eta], dtype), ONES.astype(dtype), ONES.astype(dtype)).sample(
        wo, np.full((3, 6), 1 - 2.0**-24, dtype)
    )
    length = np.sqrt((sample.wi.astype(np.float64) ** 2).sum(axis=0))
    assert np.abs(length - 1).max() < 4 * np.finfo(dtype).eps


@pytest.mark.parametrize("n", [1.33, 1.5, 2.42])
def test_s33_brewster(n):
    rs, rp, _ = fresnel.dielectric(np.array([1 / np.sqrt(1 + n * n)]), np.array([n]))
    assert rp[0] < 1e-30 and close(rs[0], ((n * n - 1) / (n * n + 1)) ** 2)


@BOTH
@pytest.mark.slow
def test_s34_a_light_pipe_neither_loses_nor_gains(dtype):
    """10 000 total reflections inside glass: the throughput stays exactly 1, directions stay unit."""
    glass = Dielectric(np.array([1.5], dtype), ONES.astype(dtype), ONES.astype(dtype))
    wi, beta = np.array([[0.9], [0.1], [-np.sqrt(1 - 0.82)]], dtype), np.ones((3, 1), dtype)
    length = np.sqrt((wi.astype(float) ** 2).sum())
    for _ in range(10_000):
        sample = glass.sample(wi, np.full((3, 1), 0.999, dtype))
        beta = beta * sample.f / sample.pdf
        wi = sample.wi * np.array([[1.0], [1.0], [-1.0]], dtype)  # the opposite wall faces the other way
        wi = np.stack((-wi[0], -wi[1], -np.abs(wi[2])))
    assert beta.dtype == dtype and (beta == 1).all()
    bar = {np.float32: 1e-6, np.float64: 1e-12}[dtype]
    assert abs(np.sqrt((wi.astype(float) ** 2).sum()) - length) < bar > abs(length - 1)


@pytest.mark.slow
@pytest.mark.parametrize(("precision", "bounces"), [(32, 1000), (64, 10_000)])
def test_s34_a_light_pipe_in_a_scene(precision, bounces):
    """A block of glass in a shining room: what is caught inside goes round 10 000 times, and what gets
    out brings exactly what it met."""
    description = {
        "sensor": {
            "type": "perspective",
            "fov": 10.0,
            "to_world": [{"look_at": {"origin": [-0.9, 0, 0], "target": [0, 0.85, 0], "up": [0, 0, 1]}}],
            "film": {"width": 4, "height": 4},
        },
        "rod": {"type": "cube", "bsdf": {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}},
        "room": {
            "type": "cube",
            "flip_normals": True,
            "to_world": [{"scale": 3}],
            "bsdf": {"type": "diffuse", "reflectance": 0.0},
            "emitter": {"type": "area", "radiance": 1.0},
        },
    }
    settings = Settings(
        spp=1, precision=precision, max_depth=bounces, strategy="bsdf", roulette="off", jitter=False
    )
    picture = tracer.render(tracer.load_dict(description), settings)
    # The camera is inside the glass, where radiance is the square of the index times as much.
    out = picture.rgb[picture.rgb > 0.0]
    assert 0 < out.size < picture.rgb.size and np.abs(out / 2.25 - 1.0).max() <= np.finfo(np.float32).eps
    assert picture.rays > bounces and picture.dropped == 0


@BOTH
@pytest.mark.parametrize("eta", [0.05, 0.5, 1.5, 4.0])
def test_s36_a_conductor_without_absorption_is_a_dielectric(eta, dtype):
    eps = np.finfo(dtype).eps
    cos = np.linspace(0, 1, 501).astype(dtype)
    column = np.full((1, 1), eta, dtype)
    one = fresnel.conductor_mean(cos, column, np.zeros((1, 1), dtype))[0]
    other, _ = fresnel.dielectric_mean(cos, np.full(501, eta, dtype))
    assert one.dtype == dtype and one[0] == 1 and other[0] == 1
    # Next to the critical angle the two forms share half their digits.
    assert np.abs(one - other).max() < 7 * np.sqrt(eps)
    away = np.abs(cos * cos - (1 - eta * eta)) > 1e-2
    assert np.abs(one - other)[away].max() < {np.float32: 2e-5, np.float64: 1e-12}[dtype]
    tiny = fresnel.conductor_mean(cos, column, np.full((1, 1), 1e-8, dtype))[0]
    # In proportion to k, steep next to the critical angle.
    assert np.abs(tiny - one)[away].max() < 1e-6


@BOTH
@pytest.mark.parametrize(("eta", "k"), [(0.05, 10.0), (0.166, 3.15), (1e-3, 1e3), (3.0, 1e-8)])
def test_s36_a_conductor_stays_within_bounds(eta, k, dtype):
    cos = np.concatenate(([0, 1e-8, 1e-4], np.linspace(0.01, 1, 100))).astype(dtype)
    columns = (np.full((3, 1), v, dtype) for v in (eta, k))
    for formula in ("exact", "schlick"):
        R = Conductor(*columns, ONES.astype(dtype), formula).reflectance_at(cos)
        columns = (np.full((3, 1), v, dtype) for v in (eta, k))
        assert R.dtype == dtype and (R >= 0).all() and (R <= 1 + ULPS * np.finfo(dtype).eps).all()
        assert (R[:, 0] == 1).all()


@pytest.mark.parametrize("eta", [1.5, 1 / 1.5, 2.42])
def test_schlick_is_the_same_from_both_sides(eta):
    """One interface, one number: from inside too the angle outside decides, and beyond it all is mirrored."""
    cos = np.linspace(0.01, 1, 200)
    R, cos_t = fresnel.dielectric_mean(cos, np.full(200, eta), "schlick")
    passed = R < 1
    back, _ = fresnel.dielectric_mean(cos_t[passed], np.full(passed.sum(), 1 / eta), "schlick")
    assert np.allclose(back, R[passed], rtol=1e-9)
    exact, _ = fresnel.dielectric_mean(cos, np.full(200, eta))
    assert np.array_equal(exact == 1, R == 1) and np.abs(exact - R).max() < 0.11
