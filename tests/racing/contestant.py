"""A program that renders on request: a child process that stays up, asked line by line.

A line to the child is a JSON object: {"spp", "seed", "how": {option: value}, "out": file}. It renders, writes
the picture (H, W, 3) to `out` as .npy and answers {"seconds", "paths"}, or {"error"} where it refuses. The
seconds are from the request understood to the picture at hand in NumPy, and so the same in every program. The
first line it says of itself: {"version"}.
"""

import ctypes.util
import glob
import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np

HERE = Path(__file__).resolve().parent
PLACES = ("/usr/lib/*/libLLVM*", "/usr/lib/llvm-*/lib/libLLVM*", "/opt/homebrew/opt/llvm/lib/libLLVM*")


class Refused(Exception):
    """What a contestant does not do, in its words."""


class Made(NamedTuple):
    """A picture and what it cost."""

    rgb: np.ndarray
    seconds: float
    paths: int


class Contestant:
    """One child process; `script` and `words` start it, pictures pass through `folder`."""

    def __init__(self, script, words, folder, **environment):
        self._out = folder / f"{Path(script).stem}-{id(self)}.npy"
        self._process = subprocess.Popen(
            [sys.executable, HERE / script, *map(str, words)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            encoding="utf-8",
            cwd=HERE.parent.parent,
            env={**os.environ, "PYTHONPATH": str(HERE.parent.parent), **environment},
        )
        self.version = self._answer()["version"]

    def _answer(self):
        line = self._process.stdout.readline()
        if not line:
            raise RuntimeError(f"{self._process.args[1]} ended with code {self._process.wait()}")
        return json.loads(line)

    def render(self, spp, seed, **how):
        """A picture as Made. Raises Refused."""
        request = {"spp": spp, "seed": seed, "how": how, "out": str(self._out)}
        self._process.stdin.write(json.dumps(request) + "\n")
        self._process.stdin.flush()
        answer = self._answer()
        if "error" in answer:
            raise Refused(answer["error"])
        return Made(np.load(self._out), answer["seconds"], answer["paths"])

    def close(self):
        """End it."""
        self._process.stdin.close()
        try:
            self._process.wait(timeout=10)
        except subprocess.TimeoutExpired:
            self._process.kill()
        self._process.stdout.close()


def serve(version, render):
    """The child's side: answer requests with render(spp, seed, how) -> (rgb, seconds, paths) until the end.

    What the program itself prints goes to standard error.
    """
    wire = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)

    def say(answer):
        print(json.dumps(answer), file=wire, flush=True)

    say({"version": version})
    for line in sys.stdin:
        request = json.loads(line)
        try:
            rgb, seconds, paths = render(request["spp"], request["seed"], request["how"])
        except (ValueError, RuntimeError) as error:
            say({"error": " ".join(str(error).split())})
            continue
        np.save(request["out"], rgb)
        say({"seconds": seconds, "paths": int(paths)})


def libllvm():
    """Where LLVM's library is, the newest there is; None if there is none."""
    said = os.environ.get("DRJIT_LIBLLVM_PATH")
    if said:
        return said
    found = [path for place in PLACES for path in glob.glob(place) if _version(path)]
    return max(found, key=lambda path: (_version(path), path), default=ctypes.util.find_library("LLVM"))


def _version(path):
    found = re.search(r"libLLVM(?:-|\.so\.)(\d+)", Path(path).name)
    return int(found[1]) if found else 0
