"""The bench for one material: right ones pass it, each planted fault is found by the property it breaks."""

import json
from dataclasses import dataclass

import numpy as np
import pytest
from suite import castray

from tracer.bsdf import Diffuse
from tracer.bsdf.sample import Sample
from tracer.material_bench import TILTS, albedo, dirac_lobes, fresnel_curves, histogram, lobes, properties
from tracer.scene_file.materials import BSDFS, bsdf

pytestmark = pytest.mark.slow

RHO = np.array([[0.8], [0.5], [0.2]])


def judged(material):
    return {p.name: p for p in properties(material, 4000)}


def inside(kind):
    return {"type": kind} | ({"bsdf": {"type": "roughplastic"}} if kind == "twosided" else {})


@pytest.mark.statistical
@pytest.mark.parametrize("kind", BSDFS)
def test_every_material_passes(kind):
    """Chi-square of four directions at 1 % in all, from the bench's own seed."""
    found = judged(bsdf(inside(kind), "here"))
    assert all(p.holds for p in found.values()), found


@dataclass(frozen=True)
class Faulty(Diffuse):
    """Diffuse with one fault."""

    fault: str = ""

    def eval(self, wo, wi):
        f = super().eval(wo, wi)
        if self.fault == "negative":
            return f - 0.1 * (wi[2] > 0.9)
        if self.fault == "one way":
            return f * (0.5 + 0.5 * np.abs(wo[2]))
        if self.fault == "bright":
            return f * 1.3
        if self.fault == "brushed":
            return f * (0.5 + 0.5 * np.abs(wi[0] * wo[0]))
        if self.fault == "sociable":
            return f + 1e-3 * wo[0].mean()
        return f

    def sample(self, wo, u):
        right = super().sample(wo, u)
        return Sample(right.wi, self.eval(wo, right.wi), right.pdf, right.delta, right.lobe)

    def pdf(self, wo, wi):
        p = super().pdf(wo, wi)
        return 0.9 * p + 0.1 * (wi[2] > 0) * (wo[2] > 0) / (2 * np.pi) if self.fault == "density" else p


@pytest.mark.statistical
@pytest.mark.parametrize(
    ("fault", "name"),
    [
        ("negative", "non-negative"),
        ("one way", "reciprocal"),
        ("bright", "energy conserving"),
        ("brushed", "isotropic"),
        ("sociable", "linear"),
        ("density", "samples follow density"),
    ],
)
def test_a_fault_is_found_by_its_property(fault, name):
    """The broken twins."""
    assert not judged(Faulty(RHO, fault=fault))[name].holds


def test_a_brushed_metal_is_not_isotropic():
    metal = bsdf({"type": "roughconductor", "alpha_u": 0.1, "alpha_v": 0.3}, "here")
    found = judged(metal)
    assert not found["isotropic"].holds and all(p.holds for n, p in found.items() if n != "isotropic")


def test_albedo_of_a_diffuse_surface_is_its_reflectance():
    reflected, transmitted, error = albedo(Diffuse(RHO), [0.0, 60.0])
    assert np.allclose(reflected, RHO, atol=1e-12) and not transmitted.any() and (error < 1e-12).all()


def test_lobes_peak_where_a_mirror_reflects_to():
    metal = bsdf({"type": "roughconductor", "alpha": 0.02}, "here")
    for tilt in (0.0, 30.0, 60.0):
        angles, value = lobes(metal, tilt, 3601)
        assert abs(angles[value[0].argmax()] - tilt) < 0.5
    ((_, angle, fraction),) = dirac_lobes(bsdf({"type": "conductor"}, "here"), 40.0)
    assert abs(angle - 40.0) < 1e-9 and np.allclose(fraction, 1)
    found = {lobe: angle for lobe, angle, _ in dirac_lobes(bsdf({"type": "dielectric"}, "here"), 40.0)}
    assert abs(found["reflection"] - 40.0) < 1e-9 and 150 < found["transmission"] < 160


@pytest.mark.parametrize("alpha", [1e-4, 0.01, 1.0])
def test_densities_are_whole_at_every_roughness(alpha):
    """What the samples lose and what the density puts into the bins make up 1."""
    for kind in ("roughconductor", "roughdielectric"):
        for tilt in TILTS:
            h = histogram(bsdf({"type": kind, "alpha": alpha}, "here"), tilt, 20_000)
            assert abs(h.expected.sum() + h.lost - 1) < 0.01


def test_fresnel_marks_brewster_and_critical():
    curves, marks = fresnel_curves(bsdf({"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}, "here"))
    assert marks["brewster"] == pytest.approx(56.30993247402021)
    assert marks["critical"] == pytest.approx(41.810314895778596)
    assert np.allclose(curves["exact"], 0.5 * (curves["Rs"] + curves["Rp"]))
    assert fresnel_curves(Diffuse(RHO)) is None
    assert fresnel_curves(bsdf({"type": "conductor"}, "here")) is None


@pytest.mark.parametrize("suffix", ["png", "svg"])
def test_the_command_draws_and_prints_json(tmp_path, suffix):
    plot = tmp_path / f"glass.{suffix}"
    done = castray("bsdf", "bk7", "alpha=0.3", "--distribution", "ggx", "-o", plot, "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    document = json.loads(done.stdout)
    assert document["material"] == {
        "type": "roughdielectric", "int_ior": "bk7", "alpha": 0.3, "distribution": "ggx",
    }  # fmt: skip
    assert {p["name"] for p in document["properties"]} >= {"reciprocal", "energy conserving", "linear"}
    assert all(p["holds"] for p in document["properties"])
    assert document["fresnel"]["brewster"] > 56
    assert plot.stat().st_size > 10_000


@pytest.mark.parametrize(
    ("words", "named"),
    [
        (["gold"], ("gold", "Au")),
        (["roughconductor", "alpha"], ("alpha", "word=value")),
        (["roughconductor", "alpha=2o"], ("roughconductor.alpha", "2o")),
        (["roughconductor", "--alfa", "0.2"], ("alfa", "alpha")),
        (["diffuse", "-o", "plot.gif"], ("plot.gif", ".png")),
        (["diffuse", "-o", "no/where.png"], ("no",)),
    ],
)
def test_what_cannot_be_benched_is_one_line(tmp_path, words, named):
    done = castray("bsdf", *words, cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    (line,) = done.stderr.splitlines()
    assert all(name in line for name in named)
