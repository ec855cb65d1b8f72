"""One percent of what `make accuracy` measures, and that it goes on where it was stopped."""

import pytest
from accuracy import kept, line, lines_of, measure, page
from figures import FAMILIES, figures

ALL = {figure.key: figure for figure in figures()}
QUICK = ("escapes-edges-far-32", "furnace-exact-64", "waves")

pytestmark = [pytest.mark.statistical, pytest.mark.slow]


@pytest.mark.parametrize(
    "key", [key if key in QUICK else pytest.param(key, marks=pytest.mark.slow) for key in ALL]
)
def test_one_percent_of_a_figure_is_good(tmp_path, key):
    sums, chunks, _ = measure(ALL[key], tmp_path, 0.01)
    assert "missed" not in line(ALL[key], sums, chunks), line(ALL[key], sums, chunks)


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
    ],
)
def test_a_bad_figure_is_marked(key, wrong):
    """The broken twins."""
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


def test_names_of_figures_are_different():
    assert len(ALL) == sum(1 for _ in figures())
