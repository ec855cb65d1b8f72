"""Mistakes of a C++ program that logs: lines of tests/cpp/castray_box.cpp written otherwise."""

import os
import shutil
import subprocess
import tempfile
from functools import partial
from pathlib import Path

from suite import ROOT

import tracer
from outside.mistake import Mistake
from tracer.doctor import examine
from tracer.trace.jsonl import header_file, read_log

SOURCE = ROOT / "tests" / "cpp" / "castray_box.cpp"
SIDE, SPP = 32, 8


def diagnosed(changes, program=SOURCE, scene="cornell", flags=()):
    """What the doctor says of a program with some of its text changed, {old: new}; flags: of the compiler."""
    text = program.read_text(encoding="utf-8")
    for old, new in changes.items():
        if text.count(old) != 1:
            raise ValueError(f"{text.count(old)} times in {program.name}: {old}")
        text = text.replace(old, new)
    with tempfile.TemporaryDirectory() as folder:
        source, built, log = (Path(folder) / name for name in ("own.cpp", "own", "own.jsonl"))
        source.write_text(text, encoding="utf-8")
        shape = (f"-DPICTURE={SIDE}", f"-DSAMPLES={SPP}")
        compiler = shutil.which("g++") or shutil.which("clang++") or "g++"
        words = [
            compiler,
            "-std=c++11",
            "-O1",
            "-pthread",
            *shape,
            *flags,
            "-I",
            header_file().parent,
            source,
        ]
        subprocess.run([*words, "-o", built], check=True)
        env = os.environ | {"CASTRAY_LOG": str(log), "CASTRAY_PIXELS": "all"}
        subprocess.run([built], env=env, check=True, stdout=subprocess.DEVNULL)
        return examine(read_log(log, tracer.load(scene)).trace)


def _of(id, words, laws, changes, fair=()):
    return Mistake(f"c++ {id}", words, laws, partial(diagnosed, changes), fair)


_DIRECT = "L_dir = lamp.emission * f * cosine * cos_light / square / pdf_light;"
_INDIRECT = "L_indir = inner * factor * cosine /"
MISTAKES = (
    _of("green-typo", "two digits of a colour exchanged", ("light-f",), {".45, .091": ".54, .091"}),
    _of(
        "one-triangle",
        "only one of the lamp's triangles is ever chosen",
        ("lamp-choice", "lamp-points"),
        {"pick < 1 ? 10 : 11": "pick < 3 ? 10 : 11"},
    ),
    _of(
        "half-the-area",
        "density of one triangle of the lamp alone",
        ("light-pdf",),
        {"1 / (triangles[10].area + triangles[11].area)": "1 / triangles[10].area"},
    ),
    _of(
        "cosine-of-the-floor",
        "the lamp's cosine with the surface's normal",
        ("light-term",),
        {"dot(-wi, of.n))": "std::fabs(dot(wi, N)))"},
    ),
    _of(
        "colour-for-f",
        "albedo where f belongs",
        ("light-term",),
        {_DIRECT: _DIRECT.replace("* f", "* hit.m->kd")},
        ("B03",),
    ),
    _of(
        "from-the-lamp",
        "the path goes on from the light point",
        ("chain",),
        {"Ray next = {p, wo}": "Ray next = {q, wo}"},
        ("B10",),
    ),
    _of(
        "frame-not-unit",
        "a tangent that is not unit",
        ("unit-direction",),
        {"T = normalize(cross(other, N))": "T = cross(other, N) * Float(.5)"},
    ),
    _of("half-a-turn", "azimuths from 0 to pi", ("directions",), {"phi = 2 * PI": "phi = PI"}, ("B09",)),
    _of(
        "other-roulette",
        "survives with 0.5, says 0.8",
        ("roulette-share",),
        {"uniform() < ROULETTE": "uniform() < Float(.5)"},
    ),
    _of(
        "old-cosine",
        "the light sample's cosine at the bounce",
        ("throughput",),
        {_INDIRECT: _INDIRECT.replace("cosine", "cos")},
    ),
    _of("two-deeper", "depth + 2", ("depth",), {"0 : depth + 1": "0 : depth + 2"}),
    _of(
        "lamp-at-depth-1",
        "the lamp's own light counts at depth 1, too",
        ("emission-weight",),
        {"depth == 0 &&": "depth <= 1 &&"},
        ("E01",),
    ),
    _of(
        "great-tolerance",
        "a shadow tolerance of half of the room",
        ("light-visible",),
        {"Float(1e-2))": "Float(300))"},
    ),
    _of(
        "blind-nearby",
        "nothing nearer than 20 mm is met",
        ("first-surface", "escape-free", "light-visible"),
        {"far < 1e-3": "far < 20"},
    ),
    _of(
        "first-normal",
        "the normal of the first triangle that is met, not of the nearest",
        ("normal", "shading-normal"),
        {"hit.n = t.n;": "if (hit.m == nullptr) hit.n = t.n;"},
    ),
    _of(
        "first-material",
        "the material of the first triangle that is met, not of the nearest",
        ("light-f", "emission"),
        {"hit.m = t.m;": "if (hit.m == nullptr) hit.m = t.m;"},
        ("E02",),
    ),
    _of(
        "direct-twice",
        "direct light is added twice",
        ("ledger",),
        {"Vec sum = L_dir + L_indir;": "Vec sum = L_dir * 2 + L_indir;"},
    ),
    _of(
        "a-tenth-lost",
        "each call returns nine tenths",
        ("throughput", "ledger"),
        {"Vec sum = L_dir + L_indir;": "Vec sum = (L_dir + L_indir) * Float(.9);"},
    ),
    _of(
        "product-of-numbers",
        "the height of directions is a product of two numbers",
        ("directions",),
        {"Float z = uniform(), phi": "Float z = uniform() * uniform(), phi"},
    ),
    _of(
        "shadow-from-above",
        "the shadow ray starts 30 mm above the surface",
        ("light-visible",),
        {"Ray shadow = {p, wi}": "Ray shadow = {p + N * Float(30), wi}"},
    ),
)
