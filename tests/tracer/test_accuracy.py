"""One percent of what `make accuracy` measures, and that it goes on where it was stopped."""

import pytest
from accuracy import kept, line, lines_of, measure, page
from figures import FAMILIES, abandoned, figures
from truth import entry, keys

ALL = {figure.key: figure for figure in figures()}
QUICK = ("escapes-edges-far-32", "furnace-exact-64", "waves")

pytestmark = [pytest.mark.statistical, pytest.mark.slow]


@pytest.mark.parametrize(
    "key", [key if key in QUICK else pytest.param(key, marks=pytest.mark.slow) for key in ALL]
)
def test_one_percent_of_a_figure_is_good(tmp_path, key):
    sums, chunks, _ = measure(ALL[key], tmp_path, 0.01)
    assert "missed" not in line(ALL[key], sums, chunks), line(ALL[key], sums, chunks)


def furnace(brighter):
    """What 100 chunks of a white furnace find that is brighter by a factor, with errors of 0.05 %."""
    found = {}
    for key in keys("albedo.ggx."):
        value = entry(key)[1]
        found[f"mean {key}"], found[f"square {key}"] = 100 * brighter * value, (100 * 5e-4 * value) ** 2
    return found


def homework(bugs, floor):
    """What 10,000 samples find of the abandoned castRay's bugs where the floor is brighter by a factor."""
    ratios = abandoned.MEASURED.get(bugs, (1.0,) * 5)
    found = {}
    for name, ratio in zip(abandoned.REGIONS, ratios, strict=True):
        found |= {f"right {name}": 1.0, f"wrong {name}": ratio * (floor if name == "floor" else 1.0)}
        found |= {f"samples {name}": 10_000, f"beyond {name}": 0.0, f"square {name}": 1e6}
    return found


def test_what_is_done_is_not_done_again(tmp_path):
    figure = ALL["furnace-exact-32"]
    first, _, _ = measure(figure, tmp_path, 0.02)
    path = tmp_path / f"{figure.key}.jsonl"
    path.write_text(path.read_text(encoding="utf-8") + '{"chunk": 1, "n"', encoding="utf-8")  # stopped here
    said = []
    again, chunks, _ = measure(figure, tmp_path, 0.06, said.append)
    assert chunks == 3 and len(said) == 2 and again["most_off"] >= first["most_off"]
    assert len(kept(tmp_path, figure)) == 3


@pytest.mark.parametrize(
    ("key", "wrong"),
    [
        ("escapes-edges-far-32", {"escaped": 1}),
        ("furnace-exact-64", {"most_off": 1e-6}),
        ("furnace-bias", {"Z": 50.0, "dropped": 0}),
        ("path-walk", {"Z": 0.0, "dropped": 1}),
        ("calibration", {"inside": 94_000, "intervals": 100_000}),
        ("waves", {"differ": 1}),
        ("continue-convex-far-32", {"rays": 1e7, "escaped": 0, "false": 1}),
        ("white-room-origin-64", {"segments": 1e7, "lit": 1.0}),
        ("lamps-outside-32", {"lit": 1}),
        ("processes", {"differ": 1}),
        ("alone", {"differ": 1}),
        ("exact-64", {"most_off": 1.1e-12, "where": ["a"]}),
        ("exact-32", {"most_off": 4.1, "where": ["a"]}),
        ("exact-estimates-32", {"found": [["a", 0.5, 0.009], ["b", 1.01, 0.009]]}),
        ("exact-estimates-64", {"found": [["a", 0.5, 0.009], ["b", 0.5, 0.011]]}),
        ("chi-square", {"p": [["a", k / 1000] for k in range(1, 1000)] + [["b", 1e-6]]}),
        ("chi-square", {"p": [["a", 0.1 + 0.8 * k / 1000] for k in range(1000)]}),
        ("weights-32", {"most_weight": 1.0 + 9 * 2.0**-23}),
        ("white-furnace-ggx-64", furnace(1.003)),
        ("invalid-32", {"dropped": 1, "negative": 0}),
        ("invalid-64", {"dropped": 0, "negative": 1}),
        ("abandoned-D06", homework("D06", 1.06)),
        ("abandoned-D01", homework("D01", 0.84)),
        ("abandoned-E01-D01", homework("E01,D01", 1.0) | {"beyond floor": 4100.0}),
        ("same-paths", {"same a": 99.8, "difference a": 0.0}),
        ("same-paths-flat", {"same a": 100.0, "difference a": 1.1e-3}),
    ],
)
def test_a_bad_figure_is_marked(key, wrong):
    """The broken twins: the smallest fault that each is to see."""
    assert "**missed**" in line(ALL[key], wrong, 100)


def test_a_part_is_measured_again_without_losing_the_other_lines(tmp_path):
    old = {key: f"| `{key}` | old | | | | | | |" for key in ALL}
    file = tmp_path / "page.md"
    file.write_text(page(old), encoding="utf-8")
    assert lines_of(file) == old
    new = page(lines_of(file) | {"waves": line(ALL["waves"], {"differ": 0}, 3, ["1234567"])})
    file.write_text(new, encoding="utf-8")
    assert "| old |" not in lines_of(file)["waves"] and "1234567" in lines_of(file)["waves"]
    assert {k: v for k, v in lines_of(file).items() if k != "waves"} == {
        k: v for k, v in old.items() if k != "waves"
    }
    assert all(f"## {family.TITLE}" in new for family in FAMILIES)
    assert "348 of 348 values" in new


def test_a_good_furnace_is_not_marked():
    assert "**missed**" not in line(ALL["white-furnace-ggx-64"], furnace(1.0), 100)


def test_names_of_figures_are_different():
    assert len(ALL) == sum(1 for _ in figures())
