"""A small log of another tracer, line by line."""

import json

import numpy as np

HEADER = {"castray": 1, "tracer": "mine", "hemisphere": "uniform", "roulette": 0.8}
# The floor and the ceiling of the homework's box: two calls, the inner one ends by roulette.
OUTER = {
    "path": 0, "x": 3, "y": 5, "sample": 0, "call": 0, "parent": -1, "depth": 0,
    "ray.o": [278, 273, -800], "ray.d": [0.0, -0.28734788556634544, 0.9578262852211514],
    "hit.p": [278, 0, 110], "hit.n": [0, 1, 0],
    "direct": [0.25, 0.25, 0.25], "bounce.wi": [0, 1, 0], "bounce.pdf": 0.15915494309189535,
    "roulette.probability": 0.8, "roulette.survived": True,
}  # fmt: skip
INNER = {
    "path": 0, "x": 3, "y": 5, "sample": 0, "call": 1, "parent": 0, "depth": 1,
    "ray.o": [278, 0, 110], "ray.d": [0, 1, 0], "hit.p": [278, 548.8, 110], "hit.n": [0, -1, 0],
    "direct": [0.5, 0.25, 0.125], "returned": [0.5, 0.25, 0.125],
    "roulette.probability": 0.8, "roulette.survived": False,
}  # fmt: skip
FACTOR = np.array([0.725, 0.71, 0.68]) / np.pi / 0.15915494309189535 / 0.8
OUTER |= {
    "indirect": (FACTOR * INNER["returned"]).tolist(),
    "returned": (0.25 + FACTOR * INNER["returned"]).tolist(),
}


def write_log(path, *lines, end="\n", head=HEADER):
    """A log of some lines, and the path of its file."""
    text = "\n".join(line if isinstance(line, str) else json.dumps(line) for line in (head, *lines))
    path.write_text(text + end, encoding="utf-8")
    return path
