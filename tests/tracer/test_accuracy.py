"""One percent of what `make accuracy` measures, and that it goes on where it was stopped."""

import pytest
from accuracy import kept, line, measure
from figures import figures

ALL = {figure.key: figure for figure in figures()}
QUICK = ("escapes-edges-far-32", "furnace-exact-64", "waves")

pytestmark = [pytest.mark.statistical, pytest.mark.slow]


@pytest.mark.parametrize(
    "key", [key if key in QUICK else pytest.param(key, marks=pytest.mark.slow) for key in ALL]
)
def test_one_percent_of_a_figure_is_good(tmp_path, key):
    sums, chunks = measure(ALL[key], tmp_path, 0.01)
    assert "missed" not in line(ALL[key], sums, chunks), line(ALL[key], sums, chunks)


def test_what_is_done_is_not_done_again(tmp_path):
    figure = ALL["furnace-exact-32"]
    first, _ = measure(figure, tmp_path, 0.02)
    path = tmp_path / f"{figure.key}.jsonl"
    path.write_text(path.read_text(encoding="utf-8") + '{"chunk": 1, "n"', encoding="utf-8")  # stopped here
    said = []
    again, chunks = measure(figure, tmp_path, 0.06, said.append)
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
