"""What the 3D view draws of paths: the selected one stands out, and a light sample ends where it ended."""

import numpy as np
import pytest

import tracer
from viewer.caption import light_outcome
from viewer.surfaces import COLOURS
from viewer.traces import Strokes, light_samples

SCENE = tracer.load("cornell_unit")
RECORD = tracer.inspect(SCENE, tracer.Settings(width=24, height=24, spp=16, max_depth=4), 12, 20)
STROKES = Strokes(2.0)


def thickness(solid):
    """The length of the shortest edge of a solid's faces: that of a rod's ring."""
    points, faces = solid
    return np.linalg.norm(points[faces[:, 0]] - points[faces[:, 1]], axis=1).min()


def test_the_way_walked_stands_out_of_what_lies_ahead_and_of_the_other_paths():
    path = next(p for p in RECORD.paths if len(p.events) > 7)
    drawn = STROKES.event(path, 3)
    assert thickness(drawn["walked"]) > 1.2 * thickness(drawn["ahead"])
    _, lines = STROKES.others(RECORD.paths, 0)["others"]
    assert lines.shape[1] == 2  # lines, without any thickness
    walked, ahead, others = (sum(COLOURS[name]) for name in ("walked", "ahead", "others"))
    assert walked > 1.3 * ahead and ahead > 1.3 * others


def test_a_light_sample_without_its_point_on_the_lamp_is_not_drawn():
    """As in a log that has what the lamp brings alone."""
    record = tracer.inspect(SCENE, tracer.Settings(width=24, height=24, spp=4, max_depth=4), 12, 20)
    path = max(record.paths, key=lambda path: len(light_samples(path)))
    for _, sample in light_samples(path):
        sample["q"] = np.full(3, np.nan)
    assert all(len(cells) == 0 for _, cells in STROKES.path(path).values())


@pytest.mark.parametrize("outcome", ["lit", "blocked"])
def test_a_light_sample_ends_at_the_lamp_or_at_what_is_in_its_way(outcome):
    seen = 0
    for path in RECORD.paths:
        ends = [
            hit["p"] + (v["distance"] if outcome == "lit" else v["blocker_distance"]) * v["wi"]
            for hit, v in light_samples(path)
            if light_outcome(v) == outcome
        ]
        points, _ = STROKES.path(path)[outcome]
        seen += len(ends)
        for end in ends:  # in a ball, or a cross
            assert np.linalg.norm(points - end, axis=1).min() < 12 * STROKES.thin
    assert seen >= 3
