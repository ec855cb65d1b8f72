"""`castray diff`: exit codes, words, JSON and map."""

import json

import numpy as np
import pytest

import tracer
from tracer import Settings
from viewer.cli import main


@pytest.fixture
def pictures(tmp_path, monkeypatch, suite_seed):
    """a and b alike but for noise, c short of light; as .exr, .png and .npy."""
    scene = tracer.load("cornell_unit")
    for name, seed, depth in (("a", suite_seed, 8), ("b", suite_seed + 1, 8), ("c", suite_seed + 2, 2)):
        settings = Settings(width=24, height=20, spp=16, seed=seed, max_depth=depth)
        picture = tracer.render(scene, settings)
        for suffix in ("exr", "png", "npy"):
            tracer.write(picture, tmp_path / f"{name}.{suffix}", scene="cornell_unit")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def diff(pictures, capsys):
    def run(*words):
        with pytest.raises(SystemExit) as ended:
            main(["diff", *map(str, words)])
        return ended.value.code, *capsys.readouterr()

    return run


def test_two_seeds_of_one_scene_are_the_same(diff):
    code, out, err = diff("a.exr", "b.exr")
    assert (code, err) == (0, "") and out.startswith("same but for noise\n")
    assert "p-value of it all" in out and "relMSE" in out


def test_missing_light_is_a_difference(diff):
    code, out, _ = diff("c.exr", "a.exr")
    assert code == 1 and out.startswith("different\n") and "darker on the whole" in out
    assert "Settings differ: max_depth 2 and 8" in out
    assert "castray inspect cornell_unit --size 24 20" in out and "--max-depth 2 --pixel" in out


@pytest.mark.parametrize(("a", "b"), [("a.png", "b.png"), ("a.exr", "b.npy"), ("a.npy", "c.npy")])
def test_without_variance_there_is_no_p_value_and_it_says_so(diff, a, b):
    code, out, _ = diff(a, b)
    assert code == 1 and "No p-value is possible" in out and "p =" not in out
    document = json.loads(diff(a, b, "--json")[1])
    assert document["p_value"] is None and document["test"] is None and document["errors"]["rmse"] > 0.0


@pytest.mark.parametrize(("a", "b"), [("a.exr", "a.npy"), ("a.png", "a.exr"), ("a.exr", "a.exr")])
def test_a_picture_is_the_same_as_itself_in_another_file(diff, a, b):
    assert diff(a, b)[0] == 0


def test_the_json_is_one_document_with_what_the_docstring_says(diff):
    from viewer.diff import as_dict

    code, out, err = diff("a.exr", "c.exr", "--json")
    document = json.loads(out)
    assert (code, err) == (1, "") and document["same"] is False and document["p_value"] < 1e-6
    names = {*document, *document["errors"], *document["test"], *document["test"]["shape"]}
    assert not [name for name in names if name not in as_dict.__doc__]
    assert [len(document["test"][name]) for name in ("Z", "bias", "bound")] == [3, 3, 3]


@pytest.mark.parametrize("suffix", ["png", "exr", "npy"])
def test_the_map_is_drawn(diff, pictures, suffix):
    assert diff("c.exr", "a.exr", "-o", f"map.{suffix}")[0] == 1
    rgb = tracer.read(pictures / f"map.{suffix}").rgb
    right = rgb[: 20 * 16, 24 * 16 + 6 :]
    assert right[..., 2].mean() > 2.0 * right[..., 0].mean(), "darker is blue"


def test_pixels_that_are_not_finite_are_yellow_and_counted(diff, pictures):
    rgb = np.load(pictures / "a.npy")
    rgb[3, 4] = np.nan
    np.save(pictures / "n.npy", rgb)
    code, out, _ = diff("n.npy", "a.npy", "-o", "map.npy")
    assert code == 1 and "1 pixels are not finite" in out
    assert (np.load(pictures / "map.npy")[3 * 16, 4 * 16] == [1, 1, 0]).all()


@pytest.mark.parametrize(
    ("words", "named"),
    [
        (("nowhere.exr", "a.exr"), "nowhere.exr"),
        (("a.exr", "text.png"), "text.png"),
        (("a.exr", "small.npy"), "24 x 20"),
        (("a.exr", "b.exr", "--alpha", "2"), "alpha"),
        (("a.exr", "b.exr", "-o", "map.jpeg"), "map.jpeg"),
    ],
)
def test_bad_input(diff, pictures, words, named):
    (pictures / "text.png").write_text("hello", encoding="utf-8")
    np.save(pictures / "small.npy", np.zeros((4, 4, 3)))
    code, out, err = diff(*words)
    assert (code, out) == (2, "") and named in err and len(err.splitlines()) == 1


def test_a_difference_of_sizes_on_its_side_is_said(diff, pictures):
    np.save(pictures / "lying.npy", np.zeros((24, 20, 3)))
    assert "on its side" in diff("a.npy", "lying.npy")[2]
