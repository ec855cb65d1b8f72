"""The machinery of `make bench` and `make race`: no number of theirs is held, but how they come about is."""

import json
import re
import sys
from types import SimpleNamespace
from xml.etree import ElementTree

import numpy as np
import pytest
import race
import suite
from bench import bench
from benchmarks import BENCH, VIEWER, scenes
from benchmarks.paper import NOT_YET, page, sections_of
from benchmarks.scaling import brute_force, fixed_and_each, wave_size
from benchmarks.section import TINY, Section, in_turn, settings, short, table
from benchmarks.stages import REST, STAGES, profile, stage
from racing import RACE, contestant, truth
from racing.judging import Entry, Race, Row, geometric, ratio
from racing.scene import for_mitsuba
from suite import ROOT

import tracer
from tracer.engine import waves
from tracer.shape.rays import Rays

DEAR = ("engines", "start", "whole", "pick", "recorder", "samplers", "sharing", "triangles")
TIMELESS = ("slopes", "sharing", "rectangles")
TRUTH = np.linspace(0.1, 1.0, 16 * 16 * 3).reshape(16, 16, 3)


def quiet(line):
    pass


@pytest.mark.parametrize(
    "section",
    [pytest.param(s, marks=pytest.mark.slow if s.key in DEAR else (), id=s.key) for s in BENCH],
)
def test_a_section_is_a_table_with_the_kernel_beside_every_time(section):
    if section.key == "engines":
        suite.gl()
    found = section.measure(TINY, quiet)
    rows = [line for line in found.splitlines() if line.startswith("|")]
    assert len({row.count("|") for row in rows}) == 1 and len(rows) > 2
    assert "nan" not in found and ("kernel ms" in found) != (section.key in TIMELESS)


def sections(*texts):
    """Sections that say one text after the other."""
    told = iter(texts)
    return (Section("lanes", "Lanes", "of waves.", lambda size, say: next(told)),)


def test_a_section_is_made_anew_alone_and_the_others_stay(tmp_path):
    out = tmp_path / "B.md"
    out.write_text(
        page((*BENCH, VIEWER, RACE), {"start": "kept\n", "race": "so is this\n"}), encoding="utf-8"
    )
    bench(out, "lanes", again=True, sections=sections("one"))
    bench(out, "lanes", again=True, sections=sections("two"))
    texts = sections_of(out)
    assert texts["lanes"].endswith("two\n") and "one" not in texts["lanes"]
    assert (texts["start"], texts["race"]) == ("kept\n", "so is this\n")
    assert texts["depth"].endswith(f"{NOT_YET}\n")
    assert [*texts] == [section.key for section in (*BENCH, VIEWER, RACE)]


def test_what_is_measured_at_this_commit_is_not_measured_again(tmp_path, monkeypatch):
    out = tmp_path / "B.md"
    for commit, times in (("abc1234", 1), ("def5678", 2), ("def5678+", 3), ("def5678+", 4)):
        monkeypatch.setattr("benchmarks.paper.commit", lambda commit=commit: commit)
        for text in (f"time {times}", "once more"):
            if text.startswith("time") or "+" not in commit:
                bench(out, sections=sections(text))
        assert sections_of(out)["lanes"].endswith(f"time {times}\n")


def test_the_paper_in_the_repository_is_what_the_command_writes():
    path = ROOT / "BENCHMARKS.md"
    assert path.read_text(encoding="utf-8") == page((*BENCH, VIEWER, RACE), sections_of(path))


def test_works_take_turns_after_a_warm_up():
    done = []
    works = {"a": lambda: done.append("a") or 0.5, "b": lambda: done.append("b")}
    times = in_turn(works, 2)
    assert done == ["a", "b", "a", "b", "a", "b"]
    assert times["a"].seconds == [0.5, 0.5] and all(t < 0.1 for t in times["b"].seconds)
    assert len(times["a"].kernels) == 2 and len(in_turn(works, 3, kernel_every=2)["a"].kernels) == 2


def test_numbers_are_short():
    assert [short(v) for v in (0.0123456, 1.5, 123.4, 123_456.0)] == ["0.0123", "1.5", "123", "123,000"]
    assert table([{"a": 1, "b": 2}]) == "| a | b |\n| --- | ---: |\n| 1 | 2 |"


def test_fixed_and_each():
    n = np.array([1, 4, 16, 64])
    assert fixed_and_each(n, 0.25 + 0.5 * n) == pytest.approx((0.25, 0.5))
    assert fixed_and_each(n, 0.5 * n - 0.01)[0] == 0.0


def test_every_stage_is_met_in_a_render():
    """So that the table keeps up with the loop's functions when they change their names."""
    scene, seen, found = tracer.load("cornell_glass"), set(), set()

    def look(frame, *_):
        calls = frame.f_code, frame.f_back and frame.f_back.f_code
        if calls not in seen:
            seen.add(calls)
            found.add(stage(frame))

    sys.setprofile(look)
    try:
        tracer.render(scene, settings(TINY, spp=16))
    finally:
        sys.setprofile(None)
    assert found == {name for name, _ in STAGES} | {REST}


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="there is no timer of processor time")
def test_a_profile_is_of_the_work():
    scene = tracer.load("cornell_unit")
    found = profile(
        lambda: [tracer.render(scene, settings(TINY, width=32, height=32, spp=16)) for _ in range(10)]
    )
    assert found and found[REST] < 0.5 * found.total()


def test_a_wave_has_the_size_asked_for_and_then_the_usual_one():
    usual = waves.LANES
    with wave_size(64):
        assert next(waves.tasks(settings(TINY))).paths <= 64
    assert usual == waves.LANES


def test_brute_force_finds_what_the_tree_finds():
    mesh = scenes.ball(2)
    random = np.random.default_rng(1)
    o = np.repeat([[0.0], [0.0], [4.0]], 500, axis=1)
    d = mesh.vertices.mean(axis=0)[:, None] + random.normal(scale=0.3, size=o.shape) - o
    d /= np.linalg.norm(d, axis=0)
    t, face = brute_force(mesh.corners(), o, d, chunk=2048)
    with np.errstate(all="ignore"):
        wanted, number = mesh.kernel(0, 4.0, np.float64).closest(Rays.towards(o, d, np.full(500, -1)))
    assert 0.1 < np.isfinite(t).mean() < 0.9
    assert np.allclose(t, wanted) and (face == number).all()


def test_many_lamps_are_as_bright_as_one():
    def power(scene):
        lit = [s for s in scene.definition.surfaces if s.radiance is not None]
        return sum(s.shape.area().sum() * s.radiance for s in lit), len(lit)

    (one, _), (many, lamps) = power(scenes.box()), power(tracer.load_dict(scenes.lit_by(10)))
    assert lamps == 10 and many == pytest.approx(one)


def test_a_ratio_is_that_of_the_logarithms():
    rows = {k: 2.0 * (1.0 + 0.1 * (-1) ** k) for k in range(10)}
    found = ratio(rows, dict.fromkeys(range(10), 1.0))
    assert found.middle == pytest.approx(2.0 * np.sqrt(1.1 * 0.9)) and found.low < 2.0 < found.high
    assert ratio(rows, rows) == pytest.approx((1.0, 1.0, 1.0))
    assert np.isnan(geometric([1.0, -1.0]).middle) and np.isnan(geometric([3.0]).low)


@pytest.mark.slow
@pytest.mark.statistical
def test_the_interval_of_a_ratio_holds_it_as_often_as_it_says(suite_seed):
    """2000 intervals of 12 pairs: 95 % or half of them hold the ratio, but for 4 standard errors."""
    random, n = np.random.default_rng(suite_seed), 2000
    noise = np.exp(random.normal(scale=0.2, size=(n, 12)))
    for level in (0.95, 0.5):
        held = sum(low <= 1.0 <= high for _, low, high in (geometric(row, level) for row in noise))
        assert abs(held / n - level) < 4.0 * np.sqrt(level * (1.0 - level) / n)
        biased = sum(low <= 1.0 <= high for _, low, high in (geometric(1.2 * row, level) for row in noise))
        assert abs(biased / n - level) > 4.0 * np.sqrt(level * (1.0 - level) / n)  # the broken twin


def rows_of(program, sampler, speed, mse, adaptive="off"):
    entry = Entry(program, sampler, adaptive)
    return [
        Row(entry, spp, seed, spp / speed, 1e-3, 256 * spp, mse / spp, 2 * mse / spp)
        for spp in (1, 16, 64)
        for seed in (1, 2, 3)
    ]


def test_the_best_sampler_of_each_program_counts():
    rows = rows_of("castray", "independent", 10.0, 1.0) + rows_of("castray", "independent", 10.0, 0.3, "mse")
    rows += rows_of("scalar_rgb", "independent", 4.0, 1.0) + rows_of("scalar_rgb", "multijitter", 2.0, 0.1)
    text = Race(rows).tables()
    assert "| paths/s | 64 | independent | scalar_rgb, independent | 2.5 [2.5, 2.5] | at least 1.8 |" in text
    assert "| time x MSE | 16 | independent | scalar_rgb, multijitter | 2 [2, 2] |" in text
    assert (
        "| time x MSE | 64 | independent, adaptive mse | scalar_rgb, multijitter | 0.6 [0.6, 0.6] |" in text
    )
    assert "| time x MSE | 1 |" not in text


def test_what_the_reference_cannot_tell_is_said():
    rows = rows_of("castray", "independent", 10.0, -1.0) + rows_of("scalar_rgb", "independent", 4.0, 1.0)
    assert "cannot be told" in Race(rows).tables()


def test_a_long_render_is_kept_piece_by_piece(tmp_path):
    pictures = np.random.default_rng(1).normal(1.0, 0.1, (5, 4, 4, 3))
    for picture in pictures:
        truth.LongRender(tmp_path / "one.npz", "key").add(picture)  # stopped after each
    found = truth.LongRender(tmp_path / "one.npz", "key").picture
    assert np.allclose(found.rgb, pictures.mean(axis=0)) and found.samples[0, 0] == 5
    assert np.allclose(found.variance, pictures.var(axis=0, ddof=1) / 5)
    assert truth.LongRender(tmp_path / "one.npz", "another").pieces == 0


class Fake:
    """A contestant whose pictures are the truth and noise, or `off` it."""

    version = "0"

    def __init__(self, seed, off=0.0):
        self.random, self.off, self.asked = np.random.default_rng(seed), off, []

    def render(self, spp, seed, **how):
        self.asked.append((spp, seed))
        if how.get("adaptive", "off") != "off" and spp < 32:
            raise contestant.Refused("too few samples")
        noise = self.random.standard_normal(TRUTH.shape) / np.sqrt(spp)
        return contestant.Made(TRUTH + self.off + noise, 1e-3 * spp, 256 * spp)

    def close(self):
        pass


@pytest.fixture
def fake_race(tmp_path, monkeypatch):
    """race.race with contestants that only pretend; keeps what they were asked."""
    monkeypatch.setattr(race, "KEPT", tmp_path / "kept")
    monkeypatch.setattr(race.whole, "measure", lambda *args: "whole processes")
    monkeypatch.setattr(race, "commit", lambda: "abc1234")
    words = ["--seeds", "3", "--spps", "4", "32", "--pieces", "8", "--piece-spp", "400", "--warm", "0"]

    def run(off=0.0, *more):
        fakes = {name: Fake(k, off * (k == 1)) for k, name in enumerate(("castray", *race.VARIANTS[1:]))}
        monkeypatch.setattr(race, "started", lambda *args: fakes)
        asked = race.options([*words, "--variants", race.VARIANTS[1], *more])
        return *race.race(asked, tmp_path)[:2], fakes

    return run


@pytest.mark.slow
def test_a_race_runs_by_turns_and_tells_ratios(fake_race, capsys):
    text, same, fakes = fake_race()
    assert same and "the same picture but for noise" in text and text.endswith("whole processes")
    found = re.search(r"time x MSE \| 32 \| [\w, ]+ \| llvm_ad_rgb, \w+ \| ([\d.]+)", text)
    assert 0.5 < float(found[1]) < 2.0
    assert "adaptive mse, 4 spp: left out: too few samples" in capsys.readouterr().out
    assert {seed for _, seed in fakes["castray"].asked} >= {1, 2, 3}


@pytest.mark.slow
def test_a_race_goes_on_where_it_was(fake_race, tmp_path):
    first, _, _ = fake_race()
    again, _, fakes = fake_race()
    assert again == first
    assert all(seed == 0 for _, seed in fakes["castray"].asked), "only warmed up"
    more, _, fakes = fake_race(0.0, "--seeds", "4")
    assert {seed for _, seed in fakes["castray"].asked} == {0, 4} and more != first


def test_programs_that_draw_different_pictures_do_not_race(fake_race):
    """The broken twin of the agreement."""
    text, same, fakes = fake_race(off=0.02)
    assert not same and "DIFFERENT" in text and "Ratios" not in text
    assert all(seed >= truth.FIRST_SEED for _, seed in fakes["castray"].asked)


def test_programs_take_turns():
    order = race.by_turns([Entry("castray", "a"), Entry("castray", "b"), Entry("x", "a"), Entry("x", "b")])
    assert [entry.program for entry in order] == ["castray", "x", "castray", "x"]


def test_mitsuba_is_told_size_depth_and_sampler(tmp_path):
    tracer.export(tracer.load("cornell_unit"), tmp_path / "box.xml")
    text = for_mitsuba((tmp_path / "box.xml").read_text(encoding="utf-8"), 24, 5, "multijitter")
    root = ElementTree.fromstring(text)
    assert root.find("integrator/integer[@name='max_depth']").get("value") == "5"
    assert {e.get("value") for e in root.findall("sensor/film/integer")} == {"24"}
    assert root.find("sensor/sampler").get("type") == "multijitter"
    assert root.find("sensor/film/rfilter").get("type") == "box"


def test_the_newest_llvm_is_found(tmp_path, monkeypatch):
    for name in ("libLLVM-9.so.1", "libLLVM-14.so", "libLLVM.so.19.1", "libLLVMSpirV.so.15"):
        (tmp_path / name).touch()
    monkeypatch.delenv("DRJIT_LIBLLVM_PATH", raising=False)
    monkeypatch.setattr(contestant, "PLACES", (f"{tmp_path}/libLLVM*",))
    assert contestant.libllvm() == f"{tmp_path}/libLLVM.so.19.1"
    monkeypatch.setenv("DRJIT_LIBLLVM_PATH", "mine.so")
    assert contestant.libllvm() == "mine.so"


@pytest.mark.slow
def test_castray_renders_on_request(tmp_path):
    tracer.export(tracer.load("cornell_unit"), tmp_path / "box.xml")
    one = contestant.Contestant("castray_child.py", (tmp_path / "box.xml", 8, 4, 1), tmp_path)
    try:
        made = one.render(2, 7, sampler="independent")
        wanted = tracer.render(
            tracer.load("cornell_unit"), tracer.Settings(width=8, height=8, spp=2, seed=7, max_depth=4)
        )
        assert (made.rgb == wanted.rgb).all() and made.paths == 128 and made.seconds > 0
        with pytest.raises(contestant.Refused, match="guess"):
            one.render(2, 7, sampler="guess")
        assert one.render(32, 7, sampler="independent", adaptive="mse").paths > 0
    finally:
        one.close()


@pytest.mark.slow
def test_the_race_with_mitsuba_itself(tmp_path, monkeypatch):
    pytest.importorskip("mitsuba")
    monkeypatch.setattr(race, "KEPT", tmp_path / "kept")
    words = ["--seeds", "2", "--spps", "4", "--side", "8", "--pieces", "4", "--piece-spp", "16"]
    words += [
        "--warm",
        "0",
        "--repeats",
        "1",
        "--whole-spp",
        "1",
        "--variants",
        "scalar_rgb",
        "--workers",
        "1",
    ]
    text, same, version = race.race(race.options(words), tmp_path)
    assert same, text
    assert "paths/s | 4 | " in text and "From the shell to a PNG" in text
    assert json.dumps(version)


def test_what_is_missing_is_one_line(monkeypatch):
    monkeypatch.setattr(race.importlib.util, "find_spec", lambda name: None)
    assert "peers" in race.missing(("scalar_rgb",))
    monkeypatch.setattr(race.importlib.util, "find_spec", lambda name: SimpleNamespace())
    monkeypatch.setattr(race, "libllvm", lambda: None)
    assert "libllvm19" in race.missing(race.VARIANTS) and race.missing(("scalar_rgb",)) == ""
