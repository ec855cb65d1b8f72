"""`castray bench`: the table, the JSON and the picture of a small scene, and what is refused."""

import json
from dataclasses import replace

import numpy as np
import pytest

import tracer
from tracer.testing import efficiency
from viewer import bench_words
from viewer.cli import main

pytestmark = pytest.mark.slow

QUICK = ("--size", "6", "4", "--max-depth", "3", "--spp", "1", "4", "--seeds", "2")

DOT = """
[sensor]
type = "perspective"
fov = 40.0
to_world = [{ look_at = { origin = [0, 0, 4], target = [0, 0, 0], up = [0, 1, 0] } }]

[dot]
type = "point"
position = [0, 2, 2]
intensity = 10

[ball]
type = "sphere"
"""


@pytest.fixture
def bench(tmp_path, monkeypatch, capsys):
    """Exit code, standard output and standard error of `castray bench WORDS`."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "dot.toml").write_text(DOT, encoding="utf-8")

    def run(*words):
        with pytest.raises(SystemExit) as ended:
            main(["bench", *map(str, words)])
        return ended.value.code, *capsys.readouterr()

    return run


def names(document, found=()):
    """Every name in a document of dicts and lists, but those of the settings."""
    if isinstance(document, dict):
        inner = [names(value) for key, value in document.items() if key != "settings"]
        return {*document, *(name for part in inner for name in part)}
    if isinstance(document, list):
        return {name for part in document for name in names(part)}
    return set(found)


def test_the_table_has_a_line_for_every_point_and_says_which_is_best(bench):
    code, out, err = bench("cornell_unit", *QUICK)
    assert (code, err) == (0, "")
    for name in ("path-mis", "path-light", "path-bsdf", "direct", "walk"):
        assert sum(line.startswith(name) for line in out.splitlines()) >= 2, name
    assert "kernel ms" in out and "seeds 1 to 2" in out and "memory" in out
    assert "reference: path, 64 samples per pixel, seed 0; its own RMSE of" in out
    assert "most efficient at 4 samples per pixel" in out.splitlines()[-1]
    assert max(map(len, out.splitlines())) <= 110


def test_the_json_is_one_document_with_what_the_docstring_says(bench):
    code, out, err = bench("cornell_unit", *QUICK, "--json", "--integrator", "path", "--strategy", "mis")
    document = json.loads(out)
    assert (code, err) == (0, "")
    assert not [name for name in names(document) if name not in bench_words.as_dict.__doc__]
    (scene,) = document["scenes"]
    assert scene["complete"] and scene["seeds"] == [1, 2] and (scene["width"], scene["height"]) == (6, 4)
    assert scene["settings"]["max_depth"] == 3 and "spp" not in scene["settings"]
    (one,) = scene["estimators"]
    assert one["memory"] > 0 and [point["spp"] for point in one["points"]] == [1, 4]
    for point in one["points"]:
        seconds = [run["seconds"] for run in point["runs"]]
        assert point["seconds"] == [np.median(seconds), min(seconds), max(seconds)]
        assert point["kernel"] > 0 and point["paths_per_second"] > 0 and len(point["runs"]) == 2


@pytest.mark.parametrize("suffix", ["png", "svg"])
def test_the_picture_is_drawn(bench, tmp_path, suffix):
    code, out, _ = bench("cornell_unit", *QUICK, "-o", f"curves.{suffix}", "--integrator", "direct")
    assert code == 0 and f"curves.{suffix}: the curves" in out
    if suffix == "svg":
        assert "<svg" in (tmp_path / "curves.svg").read_text(encoding="utf-8")
    else:
        assert tracer.read(tmp_path / "curves.png").rgb.std() > 0.05, "it is blank"


def test_several_scenes_are_rows_of_one_picture(bench, tmp_path):
    code, out, _ = bench("furnace", "cornell_unit", *QUICK, "-o", "two.png", "--integrator", "walk")
    assert code == 0 and "furnace, 6 x 4" in out and "cornell_unit, 6 x 4" in out
    one, two = (tracer.read(tmp_path / "two.png").rgb.shape[0], 5 * 120)
    assert one > 1.5 * two


def test_what_a_scene_refuses_is_left_out_and_it_is_said_why(bench):
    code, out, _ = bench("dot.toml", *QUICK)
    assert code == 0
    assert "left out: walk: walk: no ray ever meets dot" in out and "left out: path-bsdf: " in out
    document = json.loads(bench("dot.toml", *QUICK, "--json")[1])
    (scene,) = document["scenes"]
    assert [row["name"] for row in scene["skipped"]] == ["path-bsdf", "walk"]
    assert [row["name"] for row in scene["estimators"]] == ["path-mis", "path-light", "direct"]


def test_an_exact_estimator_has_no_error_to_be_seen(bench):
    words = ("furnace", *QUICK, "--roulette", "off")
    code, out, _ = bench(*words)
    assert code == 0 and "no error is to be seen at 4 samples per pixel: path-bsdf, walk" in out
    (scene,) = json.loads(bench(*words, "--integrator", "walk", "--json")[1])["scenes"]
    assert not any(point["resolved"] for point in scene["estimators"][0]["points"])


def test_samplers_and_precisions_are_named_where_there_are_several(bench):
    code, out, _ = bench("furnace", *QUICK, "--integrator", "walk", "--precision", "32", "64")
    assert code == 0 and "walk, 32 " in out and "walk, 64 " in out


def test_samples_may_go_where_the_error_is(bench):
    few = (
        "--size",
        "6",
        "4",
        "--max-depth",
        "2",
        "--seeds",
        "1",
        "--integrator",
        "path",
        "--strategy",
        "mis",
    )
    asked = ("--adaptive", "off", "--adaptive", "mse")
    code, out, _ = bench("cornell_unit", *few, *asked, "--spp", "32", "48", "--json")
    even, adaptive = json.loads(out)["scenes"][0]["estimators"]
    assert code == 0 and (even["adaptive"], adaptive["adaptive"]) == ("off", "mse")
    assert all(a["rmse"] != b["rmse"] for a, b in zip(even["points"], adaptive["points"], strict=True))
    code, out, _ = bench("cornell_unit", *few, *asked, "--spp", "4", "48")
    assert code == 0 and "left out: path-mis, adaptive mse: spp: 4; adaptive works in blocks" in out
    assert "path-mis alone was measured" in out


def test_a_bug_is_measured_against_the_right_picture(bench):
    words = (
        "furnace",
        "--size",
        "4",
        "4",
        "--max-depth",
        "4",
        "--spp",
        "1",
        "64",
        "--integrator",
        "walk",
        "--json",
    )
    (scene,) = json.loads(bench(*words, "--bug", "E01")[1])["scenes"]
    first, last = (point["rmse"][0] for point in scene["estimators"][0]["points"])
    assert last > 0.5 * first > 0.0


@pytest.fixture
def reference(tmp_path):
    """ref.exr of cornell_unit with seed 0, and the same as .npy and .png."""
    scene = tracer.load("cornell_unit")
    made = tracer.render(scene, tracer.Settings(width=6, height=4, spp=64, max_depth=3))
    for suffix in ("exr", "npy", "png"):
        tracer.write(made, tmp_path / f"ref.{suffix}", scene="cornell_unit")
    return made


def test_a_given_reference_sets_the_size_and_its_error_is_known_from_an_exr_only(bench, reference):
    words = (
        "cornell_unit",
        "--max-depth",
        "3",
        "--spp",
        "4",
        "--seeds",
        "1",
        "--integrator",
        "direct",
        "--json",
    )
    (exr,) = json.loads(bench(*words, "--reference", "ref.exr")[1])["scenes"]
    (npy,) = json.loads(bench(*words, "--reference", "ref.npy")[1])["scenes"]
    assert (exr["width"], exr["height"]) == (6, 4) and exr["reference"]["origin"] == "ref.exr"
    own = float(reference.variance.mean(dtype=np.float64))
    assert exr["reference"]["rmse"] == pytest.approx(own**0.5) and npy["reference"]["rmse"] is None
    one, other = (s["estimators"][0]["points"][0]["runs"][0]["mse"] for s in (exr, npy))
    assert one == pytest.approx(other - own)


def test_a_reference_made_otherwise_is_said(bench, reference):
    words = ("--spp", "1", "--seeds", "1", "--integrator", "direct", "--max-depth", "2")
    code, out, _ = bench("cornell_unit", *words, "--reference", "ref.exr")
    assert code == 0 and "note: max_depth is 3 in the reference and 2 here" in out


def stop_after(monkeypatch, pictures):
    """Ctrl-C in the middle of a picture, after so many whole ones."""
    right, made = efficiency.render, []

    def render(*args, **words):
        made.append(right(*args, **words))
        return replace(made[-1], complete=len(made) <= pictures)

    monkeypatch.setattr(efficiency, "render", render)


SOME = ("cornell_unit", *QUICK, "--integrator", "direct", "--integrator", "walk")


def test_ctrl_c_shows_what_is_done(bench, monkeypatch):
    stop_after(monkeypatch, 2 + 1 + 2 + 2 + 5)  # refusals, reference, memory, warming up, and some of eight
    code, out, err = bench(*SOME, "--json")
    (scene,) = json.loads(out)["scenes"]
    assert (code, err) == (130, "") and not scene["complete"]
    assert sum(len(point["runs"]) for one in scene["estimators"] for point in one["points"]) == 5


def test_ctrl_c_before_anything_is_done(bench, monkeypatch):
    stop_after(monkeypatch, 2)
    assert bench(*SOME) == (130, "", "castray: stopped before anything was measured\n")


@pytest.mark.parametrize(
    ("words", "named"),
    [
        ((), "name a scene"),
        (("nowhere",), "nowhere"),
        (("furnace", "nowhere"), "nowhere"),
        (("furnace", "--integrator", "guess"), "integrator: 'guess'"),
        (("furnace", "--strategy", "guess"), "strategy: 'guess'"),
        (("furnace", "--sampler", "guess"), "sampler: 'guess'"),
        (("furnace", "--precision", "16"), "precision: 16"),
        (("furnace", "--adaptive", "guess"), "adaptive: 'guess'"),
        (("furnace", "--spp", "0"), "spp: 0"),
        (("furnace", "--spp", "4", "many"), "'many'"),
        (("furnace", "--seeds", "0"), "seeds: 0"),
        (("furnace", "--seed", "4294967295"), "seed"),
        (("furnace", "--workers", "0"), "workers: 0"),
        (("furnace", "--reference", "nowhere.exr"), "nowhere.exr"),
        (("cornell_unit", "--reference", "ref.png"), "8 bits"),
        (("cornell_unit", "--reference", "ref.exr", "--size", "5", "5"), "is 6 x 4"),
        (("cornell_unit", "--reference", "ref.exr", "--reference-spp", "9"), "reference-spp"),
        (("cornell_unit", "furnace", "--reference", "ref.exr"), "one scene"),
        (("furnace", "--reference-spp", "0"), "spp: 0"),
        (("furnace", "-o", "curves.jpeg"), "curves.jpeg"),
        (("furnace", "-o", "no/curves.png"), "no folder"),
        (("dot.toml", "--integrator", "walk"), "no ray ever meets dot"),
    ],
)
def test_bad_input(bench, reference, words, named):
    code, out, err = bench(*words)
    assert (code, out) == (2, "") and named in err and len(err.splitlines()) == 1


def test_a_reference_of_a_measured_seed_is_refused(bench, tmp_path):
    made = tracer.render(
        tracer.load("furnace"), tracer.Settings(width=6, height=4, spp=2, seed=3, max_depth=3)
    )
    tracer.write(made, tmp_path / "three.exr")
    words = ("furnace", "--reference", "three.exr", "--max-depth", "3", "--spp", "1", "--integrator", "walk")
    code, _, err = bench(*words)
    assert code == 2 and "seed 3" in err and "--seed" in err
    assert bench(*words, "--seed", "3")[0] == 0
