"""The comparison with a peer can be trusted: its errors are right, and a small fault does not pass."""

from dataclasses import replace
from pathlib import Path

import accuracy
import numpy as np
import peers
import pytest
from cases import slow_but
from peer_definitions import of_the_peer
from peer_scenes import SCENES, with_indices
from scipy import stats

import tracer
from tracer.bsdf.metals import METALS
from tracer.scene_file.materials import bsdf

pytestmark = pytest.mark.statistical

BY_KEY = {scene.key: scene for scene in SCENES}
COATED = ("coats", "coats_own", "materials", "materials_eta_k")  # their tables take seconds


def small(key, change=lambda scene: scene):
    """A scene of few pixels; change(scene) may give another."""

    def make(folder):
        made = change(BY_KEY[key].make(folder))
        return type(made)(made.definition._replace(width=16, height=16))

    return replace(BY_KEY[key], make=make)


def darker(share):
    """A planted fault: all that is diffuse reflects less by a share."""

    def change(scene):
        described, folder = scene.definition.source
        tables = {
            name: {**table, "reflectance": (1.0 - share) * table["reflectance"]}
            if isinstance(table, dict) and table["type"] == "diffuse"
            else table
            for name, table in described.items()
        }
        return tracer.load_dict(tables, scene.name, folder)

    return change


def test_the_error_of_a_mean_of_pictures_is_how_they_scatter(suite_seed):
    rng = np.random.default_rng(suite_seed)
    pictures = rng.normal(3.0, 0.7, (24, 40, 40, 3)).astype(np.float32)
    mean = peers.together(list(pictures))
    freedom = 23 * 40 * 40 * 3
    share = mean.variance.mean() * 24 / 0.49
    low, high = stats.chi2.ppf((0.005, 0.995), freedom) / freedom
    assert low < share < high
    assert (
        not low < peers.together(list(pictures * 1.02)).variance.mean() * 24 / 0.49 < high
    )  # the broken twin
    assert (mean.samples == 24).all()
    assert np.allclose(mean.rgb, pictures.mean(axis=0), atol=1e-6)


@pytest.fixture
def with_darker_walls(tmp_path, monkeypatch, suite_seed):
    """found(share): what is found where one program's walls are darker by a share."""
    monkeypatch.setattr(peers, "PIXELS", 256)
    monkeypatch.setattr(peers, "_version", lambda: "itself")

    def found(share):
        other, _ = peers.written(small("furnace", darker(share)), tmp_path)
        wrong = Path(tmp_path) / "other.xml"
        other.rename(wrong)

        def as_wrong(path, spp, seeds):
            return peers.castray(wrong, spp, seeds)

        (tmp_path / "furnace.json").unlink(missing_ok=True)
        result = peers.measure(small("furnace"), tmp_path, 10**5, 16, suite_seed, (peers.castray, as_wrong))
        return result["found"]

    return found


@pytest.mark.slow
def test_a_program_agrees_with_itself_but_not_with_an_albedo_one_percent_off(with_darker_walls):
    assert peers.good(with_darker_walls(0.0))
    found = with_darker_walls(0.01)
    assert not peers.good(found)
    assert min(found["Z"]) > peers.BAR
    assert abs(found["bias"][0] - 0.01) < 2.0 * found["bound"][0]  # of 1 / (1 - rho) at rho = 1/2


def blank(value):
    """A program that draws nothing but noise around a value, and counts how often it is asked."""

    def program(path, spp, seeds):
        program.asked += 1
        return [np.random.default_rng(seed).normal(value, 0.1, (16, 16, 3)) for seed in seeds]

    program.asked = 0
    return program


@pytest.fixture
def measured(tmp_path, monkeypatch, suite_seed):
    """measure(programs, ...) of a small scene in one folder."""
    monkeypatch.setattr(peers, "PIXELS", 256)
    monkeypatch.setattr(peers, "_version", lambda: "Peer 1")

    def measure(programs, seed=suite_seed):
        return peers.measure(small("furnace"), tmp_path, 10**4, 32, seed, programs)

    return measure


def test_what_is_done_is_not_done_again(measured, suite_seed):
    programs = blank(1.0), blank(1.0)
    first = measured(programs)
    assert measured(programs) == first and programs[0].asked == 1
    assert measured(programs, suite_seed + 100) != first and programs[0].asked == programs[1].asked == 2
    assert first["paths"] >= 10**4


def test_the_table_says_what_missed(measured, suite_seed):
    right = measured((blank(1.0), blank(1.0)))
    wrong = measured((blank(1.0), blank(1.02)), suite_seed + 100)
    scene = small("furnace")
    assert peers.good(right["found"]) and "missed" not in peers.line(scene, right)
    assert "**missed**" in peers.line(scene, wrong)
    differs = replace(scene, differs="is another\nscene")
    assert "is another scene" in peers.line(differs, wrong) and "missed" not in peers.line(differs, wrong)


def test_the_section_is_replaced_and_outlives_the_other_figures(measured):
    results = [(small("furnace"), measured((blank(1.0), blank(1.0))))]
    page = peers.put(accuracy.page({}), peers.section(results))
    assert "Peer 1" in page and peers.put(page, peers.section(results)) == page
    assert accuracy.page({}, page) == page
    assert peers.put(page, "else\n").count("<!-- peers -->") == 1


@pytest.mark.parametrize(
    "wrong", [{"off": 1}, {"beyond": 0.02}, {"region_Z": -4.1}, {"Z": [0.0, 4.1, 0.0]}], ids=str
)
def test_each_of_the_four_figures_can_miss(wrong):
    right = {"tested": 12288, "off": 0, "beyond": 0.012, "region_Z": 3.0, "Z": [1.0, -2.0, 0.5]}
    assert peers.good(right) and not peers.good(right | wrong)


def test_a_picture_that_is_not_finite_counts_as_off(suite_seed):
    def program(value):
        return blank(value)(None, 1, range(suite_seed, suite_seed + 8))

    pictures = program(1.0)
    pictures[3][5, 5] = np.nan
    assert peers.compare(pictures, program(1.0))["off"] == 1


@pytest.mark.parametrize("key", slow_but(BY_KEY, *(key for key in BY_KEY if key not in COATED)))
def test_every_scene_goes_into_a_file_that_is_read_again(tmp_path, key):
    path, pixels = peers.written(BY_KEY[key], tmp_path)
    scene = tracer.load(path)
    assert scene.width * scene.height == pixels and abs(pixels / peers.PIXELS - 1.0) < 0.1


def test_scenes_have_names_of_their_own_and_are_at_least_eight():
    assert len(BY_KEY) == len(SCENES) and sum(not scene.differs for scene in SCENES) >= 8


def test_metals_by_their_numbers_are_the_metals():
    scene = tracer.load("materials")
    described = with_indices(scene.definition.source[0])
    assert not [t for t in described.values() if isinstance(t, dict) and t.get("material") in METALS]
    small_one = tracer.Settings(width=12, height=8, spp=2)
    other = tracer.load_dict(described, "other")
    assert np.array_equal(tracer.render(scene, small_one).rgb, tracer.render(other, small_one).rgb)


@pytest.fixture
def mitsuba():
    """The peer, if it is installed."""
    module = pytest.importorskip("mitsuba")
    module.set_variant(peers.VARIANT)
    return module


@pytest.mark.slow
@pytest.mark.parametrize("key", ["lamps", "rough_metals"])
def test_a_small_scene_is_the_same_in_the_peer(tmp_path, suite_seed, monkeypatch, mitsuba, key):
    monkeypatch.setattr(peers, "PIXELS", 256)
    found = peers.measure(BY_KEY[key], tmp_path, 10**5, 16, suite_seed)["found"]
    assert peers.good(found), found


ROUGH = {"type": "roughconductor", "eta": 0.9, "k": 2.5}
MATERIALS = (
    *({"type": name} for name in ("diffuse", "roughdielectric", "plastic", "roughplastic")),
    *({**ROUGH, "alpha": a, "distribution": d} for a in (0.1, 0.5) for d in ("ggx", "beckmann")),
    {**ROUGH, "alpha_u": 0.1, "alpha_v": 0.4, "distribution": "ggx"},
    *({"type": "roughdielectric", "alpha": 0.3, "distribution": d} for d in ("ggx", "beckmann")),
    {"type": "plastic", "nonlinear": True},
    *({"type": "roughplastic", "alpha": 0.2, "distribution": d} for d in ("ggx", "beckmann")),
)


def directions(rng, count):
    """Unit vectors (3, N) all around, none of them grazing."""
    z, phi = rng.uniform(0.05, 1.0, count) * rng.choice((-1.0, 1.0), count), rng.uniform(0.0, 7.0, count)
    r = np.sqrt(1.0 - z * z)
    return np.stack((r * np.cos(phi), r * np.sin(phi), z))


@pytest.mark.slow
@pytest.mark.parametrize("material", MATERIALS, ids=lambda m: "-".join(map(str, m.values())))
def test_a_material_is_the_peers_direction_by_direction_but_for_definitions(suite_seed, mitsuba, material):
    rng = np.random.default_rng(suite_seed)
    wo, wi = directions(rng, 150), directions(rng, 150)
    theirs = mitsuba.load_dict(dict(material))
    at, context = mitsuba.SurfaceInteraction3f(), mitsuba.BSDFContext()
    at.n = at.sh_frame.n = [0, 0, 1]
    at.sh_frame = mitsuba.Frame3f([0, 0, 1])
    expected = np.empty(150)
    for k in range(150):
        at.wi = wo[:, k]
        expected[k] = theirs.eval(context, at, wi[:, k])[0]
    known = expected > 1e-3 * expected.max()

    def off():
        ours = (bsdf(material, "m").eval(wo, wi)[0] * np.abs(wi[2]))[known]
        return np.abs(ours / expected[known] - 1.0).max()

    limit = 1e-3 if material["type"] == "roughplastic" else 1e-4  # its tables are float32 sums
    with of_the_peer():
        assert off() < limit
    assert (off() < limit) == (material["type"] == "diffuse"), "the definitions do not matter"
