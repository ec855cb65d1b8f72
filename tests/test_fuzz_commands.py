"""Random command lines end with a result or one clear line: no traceback, nothing else on standard output, no
hang. `CASTRAY_FUZZ=5000` asks for more of them.
"""

import contextlib
import io
import json
import os

import pytest
from fuzzing import EXAMPLES, FUZZ, WORDS, odd
from hypothesis import given, settings
from hypothesis import strategies as st

import tracer
from tracer import Settings
from viewer import app as viewer_app
from viewer.cli import main

pytestmark = pytest.mark.slow

ROOM = """
[sensor]
type = "perspective"
fov = 40
to_world = [{ look_at = { origin = [0, 0, 4], target = [0, 0, 0], up = [0, 1, 0] } }]
film = { width = 5, height = 4 }
[lamp]
type = "rectangle"
emitter = { type = "area", radiance = 2 }
[box]
type = "cube"
to_world = [{ scale = 0.3 }, { translate = [0, 0, 1] }]
"""
FAR = ROOM.replace("[0, 0, 1] }", "[0, 0, 1e8] }")
SCENES = [
    "room.toml",
    "room.toml",
    "room.xml",
    "far.toml",
    "furnace",
    "nowhere",
    "nowhere.toml",
    "a.exr",
    ".",
    "",
]
SCENES += [
    "http://127.0.0.1:1/#scene=furnace&size=5x4",
    "http://127.0.0.1:1/?pixel=a",
    "--",
    "-",
    "\x1b[31mroom.toml",
]
WHOLE = ["0", "1", "2", "3", "-1", "1.5", "x", "", "1e3", "99999999999", "nan", "٣", "0x2", " 1", "1_0"]
SIZES = ["1", "2", "5", "0", "-3", "x", "1e9", "65536", "99999999"]
CHOICES = {
    "--integrator": ["path", "direct", "walk", "photon"],
    "--strategy": ["mis", "light", "bsdf", "both"],
    "--heuristic": ["power", "balance", "cutoff"],
    "--hemisphere": ["cosine", "uniform"],
    "--roulette": ["auto", "off", "0.5", "1", "0", "2", "nan", "-1"],
    "--light-sampling": ["solid_angle", "area", "volume"],
    "--sampler": ["independent", "sobol"],
    "--precision": ["32", "64", "16"],
    "--bug": ["E01", "e01", "no-such-bug"],
    "--engine": ["auto", "numpy", "gl"],
    "--adaptive": ["off", "mse", "relmse", "more"],
    "--until-error": ["0.5", "0", "-1", "nan", "inf", "x"],
    "--alpha": ["0.01", "0", "1", "2", "nan", "x"],
    "-o": [
        "out.exr",
        "out.npy",
        "out.png",
        "out.xml",
        "out.svg",
        "out",
        "no/such/out.npy",
        ".",
        "",
        "room.toml",
    ],
    "--output": ["out.npy", "a.exr/out.npy"],
    "--port": ["0", "-1", "70000", "x"],
    "--sample": WHOLE,
    "--spp": ["1", "2", "32", "0", "-1", "1.5", "x", "99999999999"],
    "--seed": WHOLE,
    "--max-depth": ["0", "1", "3", "-1", "-2", "x", "99999999999"],
    "--workers": ["1", "2", "0", "-1", "x", "99999"],
    "--k": ["1", "[1,2,3]", "x", "nan"],
}
FLAGS = [
    "--json",
    "--explain",
    "--help",
    "--version",
    "--no-jitter",
    "--jitter",
    "--no-browser",
    "--no-json",
    "--",
]
PAIRS = ["--size", "--pixel"]
option = st.one_of(
    st.sampled_from(sorted(CHOICES)).flatmap(lambda f: st.tuples(st.just(f), st.sampled_from(CHOICES[f]))),
    st.sampled_from(sorted(CHOICES)).flatmap(lambda f: st.tuples(st.just(f), odd)),
    st.sampled_from(FLAGS).map(lambda flag: (flag,)),
    st.tuples(st.sampled_from(PAIRS), st.sampled_from(SIZES), st.sampled_from(SIZES)),
    st.tuples(st.sampled_from(PAIRS), st.sampled_from(SIZES)),
    odd.map(lambda word: (word,)),
    st.tuples(st.sampled_from(WORDS).map(lambda word: f"--{word}"), odd),
)
CHEAP = ["--size", "5", "4", "--spp", "1"]
commands = st.one_of(
    st.tuples(st.sampled_from(["render", "export", "view"]), st.sampled_from(SCENES)).map(list),
    st.sampled_from(SCENES).map(lambda scene: ["inspect", scene, "--pixel", "1", "2"]),
    st.sampled_from(SCENES).map(lambda scene: ["bench", scene, "--seeds", "2", "--reference-spp", "2"]),
    st.lists(st.sampled_from(["a.exr", "b.exr", "c.npy", *SCENES]), max_size=3).map(lambda f: ["diff", *f]),
    st.tuples(
        st.just("bsdf"), st.sampled_from(["Au", "bk7", "diffuse", "plastic", "dielectric", "x", ""])
    ).map(list),
    st.sampled_from([["bugs"], ["bugs", "E01"], ["bugs", "E99"]]),
    st.lists(odd, max_size=3),
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder to stand in, with some scenes and pictures; the viewer serves nothing there."""
    folder, before, run = tmp_path_factory.mktemp("commands"), os.getcwd(), viewer_app._run
    for name, text in (("room.toml", ROOM), ("far.toml", FAR)):
        (folder / name).write_text(text, encoding="utf-8")
    scene = tracer.load(folder / "room.toml")
    tracer.export(scene, folder / "room.xml")
    for seed, name in enumerate(("a.exr", "b.exr", "c.npy")):
        tracer.write(tracer.render(scene, Settings(spp=4, seed=seed)), folder / name)
    os.chdir(folder)
    viewer_app._run = lambda *_: None
    yield folder
    viewer_app._run = run
    os.chdir(before)


def run(words):
    """Exit code, standard output and standard error of `castray WORDS`."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), pytest.raises(SystemExit) as ended:
        main(words)
    return ended.value.code, out.getvalue(), err.getvalue()


@settings(FUZZ, max_examples=max(EXAMPLES, 200))
@given(commands, st.lists(option, max_size=3), st.booleans())
def test_any_command_line_ends_with_a_result_or_one_line(folder, command, options, cheap):
    cheap = CHEAP if cheap or command[:1] != ["render"] else ()
    words = [*command, *cheap, *(word for words in options for word in words)]
    code, out, err = run([word.replace("\0", "") for word in words])  # no system passes a NUL on
    assert code in (0, 1, 2), (code, err)
    lines = err.splitlines()
    assert all(line.startswith("castray: ") and line.isprintable() for line in lines), err
    if code == 2:
        assert not out and lines, (out, err)
    elif "--json" in words and not {"--help", "-h", "--version"} & set(words) and command[:1] != ["export"]:
        json.loads(out)
