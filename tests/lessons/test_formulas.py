"""Formulas of the lessons, written out as they are printed there, are what the tracer's functions compute."""

from functools import cache

import numpy as np
import pytest
from cases import loaded
from rough import direction, facets, numbers

import tracer
from tracer import Settings, warp
from tracer.bsdf import Dielectric, Plastic, RoughConductor, fresnel
from tracer.bsdf.microfacet import mirrored, reflected
from tracer.film import gather
from tracer.frame import Frame, dot, length, normalize
from tracer.integrator import steps
from tracer.sampler.numbers import uniform

N = 200


def directions(seed):
    """N directions above a surface, (3, N)."""
    return warp.cosine_hemisphere(numbers(seed, N, np.float64))


@cache
def homework():
    """The homework's box in double precision, and recorded paths of some of its pixels."""
    settings = Settings(
        width=24, height=24, spp=4, precision=64, integrator="direct", light_sampling="area", roulette="0.8"
    )
    scene = loaded("cornell")
    paths = [path for x in (3, 8, 12, 17) for path in tracer.inspect(scene, settings, x, 14).paths]
    return scene.at(settings), paths


def with_vertex(path):
    """(the hit's values, the event) of each event behind a hit."""
    hit = None
    for event in path.events:
        if event.kind.name == "hit":
            hit = event.values
        elif hit is not None:
            yield hit, event


def test_a_hit_lies_t_along_its_ray_and_wo_points_back():
    """x' = x + t w, wo = -w."""
    seen = 0
    for path in homework()[1]:
        point, way = path.events[0].values["o"], path.events[0].values["d"]
        for hit, event in with_vertex(path):
            if event.kind.name == "bounce":
                assert np.allclose(hit["p"], point + hit["t"] * way, atol=1e-9)
                assert np.allclose(hit["wo"], -way, atol=1e-15)
                point, way, seen = hit["p"], event.values["wi"], seen + 1
    assert seen > 20


def test_throughput_is_multiplied_by_f_cos_over_pdf_and_divided_by_the_roulettes_chance():
    seen = {"bounce": 0, "roulette": 0}
    for path in homework()[1]:
        beta = np.ones(3)
        for _, event in with_vertex(path):
            v, kind = event.values, event.kind.name
            if kind == "bounce":
                beta = beta * v["f"] * v["cos"] / v["pdf"]
            elif kind == "roulette" and v["survived"]:
                beta = beta / v["probability"]
            if kind in seen and v.get("survived", True):
                assert np.allclose(v["beta"], beta, rtol=1e-12)
                seen[kind] += 1
    assert min(seen.values()) > 20


def test_a_light_sample_brings_its_product_per_solid_angle_and_per_area():
    """beta f Le cos V w / pdf, and with the measure changed beta f Le cos cos_light V / (r^2 pdf_area)."""
    (scene, paths), seen = homework(), 0
    for path in paths:
        beta = np.ones(3)
        for _, event in with_vertex(path):
            if event.kind.name == "light":
                v = event.as_dict(scene)
                product = beta * v["f"] * v["Le"] * v["cos"] * v["visible"]
                if v["pdf"] > 0.0:
                    assert np.allclose(v["contribution"], product * v["w"] / v["pdf"], rtol=1e-9)
                    per_area = product * v["cos_light"] / (v["distance"] ** 2 * v["pdf_area"])
                    assert np.allclose(v["contribution"], per_area, rtol=1e-9)
                    seen += bool(v["visible"])
            beta = event.values["beta"] if event.kind.name in ("bounce", "roulette") else beta
    assert seen > 20


def test_points_of_a_lamp_have_the_density_one_over_its_area():
    scene, paths = homework()
    (area,) = {shape.area().sum() for shape in scene.shapes if shape.name == "lamp"}
    events = [e for path in paths for _, e in with_vertex(path)]
    lights = [
        e.as_dict(scene)["pdf_area"] for e in events if e.kind.name == "light" and e.values["pdf"] > 0.0
    ]
    assert len(lights) > 20 and np.allclose(lights, 1.0 / area, rtol=1e-12)


@pytest.mark.statistical
def test_directions_to_a_lamp_have_the_density_one_over_its_solid_angle(suite_seed):
    """The angle is counted: the share of even directions that meet the lamp, times 2 pi."""
    scene, by_area = (
        loaded("cornell").at(Settings(precision=64, light_sampling=by)) for by in ("solid_angle", "area")
    )
    p = np.repeat([[278.0], [500.0], [280.0]], 100_000, axis=1)
    d = warp.uniform_hemisphere(numbers(suite_seed, p.shape[1], np.float64))[[0, 2, 1]]
    with np.errstate(all="ignore"):
        _, primitive = scene.intersect(p, d, np.full(p.shape[1], -1))
    share = (scene.light_of[primitive] >= 0).mean()
    u = numbers(suite_seed + 1, N, np.float64)[[0, 0, 1]]
    error = np.sqrt(share * (1.0 - share) / p.shape[1]) / share
    assert 4.0 * error < 0.02  # significance: four standard errors
    even, uneven = (
        np.abs(s.sample_light(p[:, :N], u).pdf * (2.0 * np.pi * share) - 1.0).max() for s in (scene, by_area)
    )
    assert even < 4.0 * error < uneven  # the broken twin: points that are even over the area


def test_a_point_of_a_lamp_is_seen_where_nothing_is_met_before_it():
    """V = 1 where t_first >= |q - p|, to a ten-thousandth of the way."""
    (scene, paths), seen = homework(), set()
    for path in paths:
        for hit, event in with_vertex(path):
            if event.kind.name == "light" and event.values["pdf"] > 0.0:
                q, p = event.values["q"], hit["p"]
                far = np.linalg.norm(q - p)
                o = (p + 1e-9 * far * hit["ng"])[:, None]
                with np.errstate(all="ignore"):
                    t, _ = scene.intersect(o, ((q - p) / far)[:, None], np.full(1, -1))
                assert event.values["visible"] == (t[0] >= far * (1.0 - 1e-4))
                seen.add(bool(event.values["visible"]))
    assert seen == {True, False}


@pytest.mark.parametrize("strategy", ["mis", "light", "bsdf"])
@pytest.mark.parametrize("heuristic", ["power", "balance"])
def test_the_weights_of_both_ways_to_a_lamp_sum_to_one(suite_seed, strategy, heuristic):
    settings = Settings(strategy=strategy, heuristic=heuristic)
    by_light, by_bounce = 0.01 + 100.0 * numbers(suite_seed, N, np.float64)
    found = steps.emission_weight(settings, strategy, by_bounce, by_light)
    asked = steps.light_weight(settings, strategy, by_light, by_bounce) if strategy != "bsdf" else 0.0
    assert np.allclose(found + asked, 1.0, rtol=1e-14)


def test_light_of_two_lamps_is_the_sum_of_each():
    """L(L1 + L2) = L(L1) + L(L2)."""
    scene = loaded("cornell").at(Settings(precision=64))
    sample = scene.sample_light(
        np.repeat([[278.0], [100.0], [280.0]], N, axis=1), numbers(1, N, np.float64)[[0, 0, 1]]
    )
    one, two = sample.Le, sample.Le[::-1] ** 2

    def sent(Le):
        return steps.light_term(np.ones((3, N)), 0.2, np.full(N, 0.7), sample._replace(Le=Le), 1.0)

    assert sent(one).all() and np.allclose(sent(one + two), sent(one) + sent(two), rtol=1e-13)


def test_the_mean_of_both_polarisations_is_what_is_used(suite_seed):
    """F = (Rs + Rp) / 2, from either side of water."""
    cos = numbers(suite_seed, N, np.float64)[0]
    for eta in (1.333, 1.0 / 1.333):
        across, within, _ = fresnel.dielectric(cos, eta)
        mean, _ = fresnel.dielectric_mean(cos, np.full(N, eta))
        assert np.allclose(mean, (across + within) / 2.0, rtol=1e-14)


def test_varnish_lets_light_through_on_its_way_in_and_out(suite_seed):
    """(1 - F(wo)) (1 - F(wi)) rho / (pi c) with c = eta^2 (1 - F_in)."""
    rho = np.array([[0.1], [0.25], [0.5]])
    coat = Plastic.coated(np.array([1.5]), rho, np.ones((3, 1)))
    wo, wi = directions(suite_seed), directions(suite_seed + 1)
    through = (1.0 - coat.reflectance_at(wo[2])) * (1.0 - coat.reflectance_at(wi[2]))
    c = coat.eta**2 * (1.0 - coat.inside)
    assert np.allclose(coat.eval(wo, wi), through * rho / (np.pi * c), rtol=1e-12)


def test_the_facet_of_two_directions_is_half_way_between_them(suite_seed):
    wo, wi = directions(suite_seed), directions(suite_seed + 1)
    half = (wo + wi) / length(wo + wi)
    at = mirrored(facets("ggx", 0.2, 0.2), wo, wi)
    assert np.allclose(at.m, half, atol=1e-12)
    assert np.allclose(reflected(wo, half), wi, atol=1e-12)


def test_facets_of_ggx_have_the_density_that_is_printed(suite_seed):
    """With one roughness, with two, and at the peak 1 / (pi alpha^2)."""
    m, alpha, u, v = directions(suite_seed), 0.15, 0.05, 0.3
    cos2 = m[2] ** 2
    round_ = alpha**2 / (np.pi * (cos2 * (alpha**2 - 1.0) + 1.0) ** 2)
    assert np.allclose(facets("ggx", alpha, alpha).D(m), round_, rtol=1e-10)
    brushed = 1.0 / (np.pi * u * v * (m[0] ** 2 / u**2 + m[1] ** 2 / v**2 + cos2) ** 2)
    assert np.allclose(facets("ggx", u, v).D(m), brushed, rtol=1e-10)
    peak = facets("ggx", alpha, alpha).D(direction(1.0))
    assert np.allclose(peak, 1.0 / (np.pi * alpha**2), rtol=1e-14)


def test_a_rough_mirrors_bounce_weighs_g2_over_g1_and_has_the_density_of_what_is_seen(suite_seed):
    """f cos / pdf = F G2 / G1, and pdf = D(h) G1(wo) / (4 cos_o)."""
    one = np.ones((3, 1))
    alpha = np.array([0.4])
    metal = RoughConductor(alpha, alpha, one, np.full((3, 1), 3.0), one)
    wo = directions(suite_seed)
    sample = metal.sample(wo, numbers(suite_seed + 1, N, np.float64)[[0, 0, 1]])
    up = sample.pdf > 0.0
    wo, wi, f, pdf = wo[:, up], sample.wi[:, up], sample.f[:, up], sample.pdf[up]
    h, rough = normalize(wo + wi), metal.facets
    F = metal.reflectance_at(dot(wo, h))
    assert up.sum() > N / 2
    assert np.allclose(f * wi[2] / pdf, F * rough.G2(wo, wi) / rough.G1(wo), rtol=1e-9)
    assert np.allclose(pdf, rough.D(h) * rough.G1(wo) / (4.0 * wo[2]), rtol=1e-9)


def test_a_frame_along_a_surface_has_its_tangent_made_perpendicular(suite_seed):
    """s = (t - (t n) n) / |t - (t n) n|."""
    n, t = directions(suite_seed), directions(suite_seed + 1)
    across = t - dot(t, n) * n
    assert np.allclose(Frame.along(n, t).s, across / length(across), atol=1e-12)


def test_a_lamp_that_is_found_or_not_spreads_by_its_chance(suite_seed):
    """sigma = X sqrt(P (1 - P))."""
    X, P, n = 4.5, 0.0625, 4096
    samples = np.zeros((3, n))
    samples[:, : int(P * n)] = X
    film = gather(samples)
    unbiased = np.sqrt(film.sample_variance() * (n - 1) / n)
    assert np.allclose(unbiased, X * np.sqrt(P * (1.0 - P)), rtol=1e-12)


def test_the_swimmers_window_has_the_radius_depth_times_tangent():
    """Along rays from a depth d all light is reflected from r = d tan(critical angle) on."""
    eta, depth = 1.333, 2.0
    water = Dielectric(np.array([eta]), np.ones((3, 1)), np.ones((3, 1)))
    radius = depth * np.tan(np.arcsin(1.0 / eta))
    far = radius * np.array([0.5, 0.999, 1.001, 2.0])
    to = np.stack((far, np.full(4, depth), np.zeros(4)))
    wo = np.stack((np.zeros(4), -far, -np.full(4, depth))) / length(to)  # seen from below
    got_through = water.sample(wo, np.full((3, 4), 0.999)).wi[2] > 0.0
    assert got_through.tolist() == [True, True, False, False]


def test_a_word_is_a_number_by_its_upper_bits(suite_seed):
    """u = floor(w / 2^8) 2^-24."""
    words = np.random.default_rng(suite_seed).integers(0, 2**32, N, dtype=np.uint64).astype(np.uint32)
    assert np.array_equal(uniform((words,), np.float32)[0], np.floor(words / 2.0**8) * 2.0**-24)
