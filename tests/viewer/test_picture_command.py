"""`castray doctor PICTURE` on the command line."""

import io
import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from rich.console import Console
from suite import castray

import tracer
from lessons.zoo import ZOO
from tracer.doctor.picture import Wall, strangest
from tracer.doctor.picture.clues import EVEN, UNSEEN, VARIES, Clues, Seen
from tracer.scene_file.change import changed
from viewer import picture_examining
from viewer.picture_report import beyond, print_objects
from viewer.words import Speaker

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with a picture of a mistake, a right one, and what is none."""
    folder = tmp_path_factory.mktemp("pictures")
    scene, bug = tracer.load("cornell"), ZOO["D06"]
    settings = bug.asked(width=40, height=40, spp=8, seed=5)
    tracer.write(tracer.render(scene, settings, steps=bug.steps).rgb, folder / "红墙 mine.png")
    tracer.write(tracer.render(scene, settings).rgb, folder / "right.png")
    (folder / "text.png").write_text("no picture", encoding="utf-8")
    (folder / "cut.ppm").write_bytes(b"P6\n40 40\n255\n" + bytes(100))
    (folder / "empty.ppm").write_bytes(b"P6\n0 0\n255\n")
    (folder / "huge.ppm").write_bytes(b"P6\n40000 25000\n255\n")
    np.save(folder / "nan.npy", np.full((16, 16, 3), np.nan))
    np.save(folder / "tiny.npy", np.ones((4, 4, 3)))
    return folder


def test_a_picture_gives_hypotheses_and_no_findings(folder):
    ran = castray("doctor", folder / "红墙 mine.png", "--scene", "cornell", env={"COLUMNS": "80"})
    assert ran.returncode == 0, ran.stderr
    for words in (
        "fits D06",
        "no findings",
        "to prove it, log light.f",
        "castray bugs D06",
        "left_wall",
        "castray view cornell --compare",
    ):
        assert words in ran.stdout
    assert max(map(len, ran.stdout.splitlines()[1:-1])) <= 80


def test_where_nothing_fits_the_object_that_stands_out_is_named_and_what_to_do_next(tmp_path):
    exchanged = changed(tracer.load("cornell"), {"red.reflectance": (0.065, 0.63, 0.05)})
    dark = replace(ZOO["D10"].asked(width=40, height=40, spp=16), roulette="0.5")
    mine = tmp_path / "mine.png"
    tracer.write(tracer.render(exchanged, dark).rgb, mine)
    said = " ".join(castray("doctor", mine, "--scene", "cornell").stdout.split())
    assert "the colour of left_wall" in said and "castray check FILE.py" in said


@pytest.mark.parametrize(
    ("ratios", "name", "coloured"),
    [
        (((1.0, 1.1, 0.9), (0.9, 1.0, 1.0), (0.2, 5.0, 1.0)), "wall 2", True),
        (((1.0, 1.1, 0.9), (0.9, 1.0, 1.0), (0.3, 0.3, 0.3), (1.0, 1.0, 1.0)), "wall 2", False),
        (((0.5, 0.5, 0.5), (0.6, 0.5, 0.5), (0.4, 0.5, 0.5)), None, False),
    ],
)
def test_the_object_that_stands_out_is_unlike_the_others(ratios, name, coloured):
    walls = [Wall(f"wall {k}", np.array(ratio), 0.1, np.ones((8, 8), bool)) for k, ratio in enumerate(ratios)]
    wall, of_colour = strangest(walls)
    assert (wall and wall.name, of_colour) == (name, coloured)


def test_its_json_keeps_hypotheses_and_findings_apart(folder):
    ran = castray("doctor", folder / "红墙 mine.png", "--scene", "cornell", "--json", "--spp", 8)
    said = json.loads(ran.stdout)
    first = said["hypotheses"][0]
    assert ran.returncode == 0 and said["findings"] == [] and first["bugs"] == ["D06"]
    assert 0.5 < first["explains"] <= 1.0 and "light.f" in first["log"]
    assert first["evidence"]["left_wall"]["yours"][1] > 3.0


def test_a_right_picture_is_called_right_and_drawn_beside_the_reference(folder, tmp_path):
    out = tmp_path / "beside.png"
    ran = castray("--lang", "zh", "doctor", folder / "right.png", "--scene", "cornell", "-o", out)
    assert ran.returncode == 0 and "吻合" in ran.stdout and out.exists()


@pytest.mark.parametrize(
    "name", ["text.png", "cut.ppm", "empty.ppm", "huge.ppm", "nan.npy", "tiny.npy", "none.png"]
)
def test_what_is_no_picture_is_one_line_and_code_2(folder, name):
    ran = castray("doctor", folder / name, "--scene", "cornell")
    assert ran.returncode == 2 and len(ran.stderr.splitlines()) == 1 and name in ran.stderr and not ran.stdout


@pytest.mark.parametrize(
    "words",
    [("right.png",), ("right.png", "--scene", "cornell", "--gamma", "0"),
     ("right.png", "--scene", "cornell", "--bug", "E01"),
     ("right.png", "--scene", "cornell", "-o", "no/such.png"), ("cornell", "--gamma", "2")],
)  # fmt: skip
def test_options_that_do_not_fit_are_one_line_and_code_2(folder, words):
    ran = castray("doctor", *words, cwd=folder)
    assert ran.returncode == 2 and len(ran.stderr.splitlines()) == 1 and not ran.stdout


ODD = Seen("left_wall", np.array([0.9, 1.1, 1.2]), 0.6, VARIES, (0.6, (24, 40)), (1.5, (8, 88)))
CUT = Seen("lamp", np.ones(3), float("nan"), UNSEEN)
FLOOR = Seen("floor", np.full(3, 0.5), 0.7, EVEN, (0.5, (1, 2)), (0.5, (3, 4)))
THREE = ("light.f", "light.cos", "light.pdf")
NONE = {"objects": (CUT, FLOOR), "agree": (1, 50), "straight": (0, 9), "around": (0, 0), "below": (0, 40),
        "dim": False, "power": None, "of_material": False, "log": THREE}  # fmt: skip


@pytest.mark.parametrize(
    ("what", "en", "zh"),
    [
        ({"dim": True, "agree": (20, 50)}, "So exposure, the curve", "所以曝光"),
        ({"straight": (7, 9)}, "So the light sample is right there", "那里的光源采样是对的"),
        (
            {"below": (9, 40)},
            "9 of 40 places are darker than the light straight",
            "有 9 处比仅由光源直接照亮时还暗",
        ),
        (
            {"around": (3, 8)},
            "3 of 8 places that get hardly any light straight",
            "在几乎没有直接光的 8 处中，有 3 处",
        ),
        ({"power": 0.6}, "more too bright it is, about as right^0.60", "正确值的 0.60 次方"),
        ({"power": 1.6}, "more too dark it is, about as right^1.60", "过暗得越多"),
        ({"of_material": True}, "It goes with the material", "偏差随材质而定"),
        (
            {"objects": (FLOOR, ODD)},
            "0.6 near pixel (24, 40), 1.5 near (8, 88)",
            "在像素 (24, 40) 附近是 0.6",
        ),
    ],
)
def test_what_is_said_of_a_picture_that_nothing_fits_follows_from_its_clues(what, en, zh):
    reading = SimpleNamespace(turn=None, shape=None)
    opinion = SimpleNamespace(clues=Clues(**NONE | what), reading=reading, walls=())
    plain = SimpleNamespace(clues=Clues(**NONE), reading=reading, walls=())
    for language, words in (("en", en), ("zh", zh)):
        say = Speaker(language)
        told, least = (" ".join(beyond(o, "my box.toml", say)) for o in (opinion, plain))
        assert words in told and words not in least
        assert 'CASTRAY_LOG("light.f", f, "light.cos", cos, "light.pdf", pdf)' in told
        assert "castray doctor castray.jsonl --scene 'my box.toml'" in told and "{" not in told
        console = Console(file=io.StringIO(), width=80)
        print_objects(opinion.clues, say, console)
        assert all(name in console.file.getvalue() for name in ("floor", "70%"))


def test_the_command_says_what_agrees_and_what_to_log_where_nothing_fits(tmp_path):
    right = tracer.render(tracer.load("cornell"), ZOO["D06"].asked(width=48, height=48, spp=16, seed=5)).rgb
    odd = right * np.where(np.arange(48) < 20, 1.0, np.linspace(0.3, 2.5, 48))[None, :, None]
    tracer.write(odd.astype(np.float32), tmp_path / "odd.png")
    ran = castray("doctor", tmp_path / "odd.png", "--scene", "cornell", env={"COLUMNS": "80"})
    assert ran.returncode == 0, ran.stderr
    said = " ".join(ran.stdout.split())
    for words in (
        "nothing in the catalogue fits",
        "So exposure, the curve",
        "Log these three next",
        "CASTRAY_LOG(",
    ):
        assert words in said
    clues = json.loads(castray("doctor", tmp_path / "odd.png", "--scene", "cornell", "--json").stdout)[
        "clues"
    ]
    assert clues["agree"]["places"] >= 10 and len(clues["log"]) == 3


def test_the_page_tells_how_far_the_mistakes_are_rendered(monkeypatch):
    rival = SimpleNamespace(name="mine.png")
    guess = picture_examining.Guess(rival, busy=True, rendered=(12, 74))
    monkeypatch.setattr(picture_examining, "guess_of", lambda session: guess)
    assert "12 of 74" in picture_examining.shown(None, Speaker("en"))["status"]
    guess.busy = False
    assert picture_examining.shown(None, Speaker("en"))["status"] == ""
