"""Logs of events that say little, and lamps chosen in the program's own way."""

import json
from dataclasses import replace

import numpy as np
import pytest

import tracer
from tracer.doctor.evidence import Evidence
from tracer.integrator import steps
from tracer.light import choice
from tracer.trace.gather import gather
from tracer.trace.jsonl import read_log

SIZE = {"width": 4, "height": 3, "spp": 2, "precision": 64, "max_depth": 6}
SAID = {
    "camera": ("o", "d"),
    "hit": ("p", "contribution"),
    "light": ("q", "visible", "contribution"),
    "bounce": ("wi", "beta"),
    "end": ("reason", "radiance"),
}
FOLLOWS = {
    "hit": ("primitive", "wo", "n", "ng"),
    "light": ("primitive", "light", "wi", "distance", "cos"),
    "bounce": ("cos", "delta"),
}


@pytest.fixture(scope="module")
def scene():
    return tracer.load("cornell_glass")


@pytest.fixture
def read(tmp_path, scene):
    """A log of castray's own events, each changed first; what is left of them, read."""

    def log(change):
        settings, path = tracer.Settings(**SIZE), tmp_path / "own.jsonl"
        with open(path, "w", encoding="utf-8") as file:
            head = {"castray": 1, "bits": 64, "digits": 17, "integrator": "path", "spp": 2, "max_depth": 6}
            print(json.dumps(head | {"width": 4, "height": 3}), file=file)
            for y, x in np.ndindex(3, 4):
                record = tracer.inspect(scene, settings, x, y).as_dict(scene.at(settings))
                for sample in record["samples"]:
                    for event in sample["events"]:
                        place = {"x": x, "y": y, "sample": sample["sample"]}
                        print(json.dumps(place | change(event)), file=file)
        return read_log(path, scene)

    return log


def spare(event):
    kept = ("kind", "depth", *SAID.get(event["kind"], ()))
    return {name: value for name, value in event.items() if name in kept}


def test_points_and_directions_are_enough_to_know_what_was_met(read, scene):
    log = read(spare)
    own = gather(scene, tracer.Settings(**SIZE)).tables
    for kind, names in FOLLOWS.items():
        for name in names:
            found = log.trace.tables[kind][name]
            np.testing.assert_allclose(found, own[kind][name], atol=1e-9, err_msg=f"{kind}.{name}")
    assert not tracer.examine(log.trace).causes


def test_what_follows_from_the_scene_is_not_called_right(read):
    held = {v.rule.id for v in tracer.examine(read(spare).trace).rules if v.state != "not_testable"}
    assert "on-surface" in held and not held & {"shading-normal", "wo", "light-distance", "light-cos"}


def test_a_point_on_no_lamp_is_still_told(read):
    def aside(event):
        event = spare(event)
        return event | {"q": [0.2, 0.3, 0.1]} if event["kind"] == "light" else event

    assert "light-point" in [finding.rule for finding in tracer.examine(read(aside).trace).findings]


@pytest.mark.parametrize("lit", [False, True])
def test_visibility_may_be_left_out_where_nothing_arrives(read, lit):
    def silent(event):
        if event["kind"] == "light" and (any(event["contribution"]) == lit):
            event = {name: value for name, value in event.items() if name != "visible"}
        return event

    log = read(silent)
    assert (log.trace.tables["light"]["visible"] is None) == lit
    assert any("light.visible is in" in note for note in log.notes) == lit
    assert not tracer.examine(log.trace).causes


@pytest.mark.parametrize(
    ("pick", "taken"),
    [
        (lambda light, n: np.full(light.size, 1 / n), True),  # all alike
        (lambda light, n: (1.0 + light) / (n * (n + 1) / 2), True),
        (lambda light, n: np.ones(light.size), False),  # left out
        (lambda light, n: np.arange(light.size) / light.size, False),  # no number of the lamp
        (lambda light, n: np.where(light == 0, 0.0, 1 / (n - 1)), False),
    ],
)
def test_lamps_may_be_chosen_with_any_probabilities_that_add_up(pick, taken):
    lights = tracer.load("many_lights")
    lamps = Evidence(gather(lights, tracer.Settings(width=2, height=2, spp=1, precision=64))).lamps
    n = len(lights.light_names)
    light = np.tile(np.arange(n), 3)
    own = lamps.pick
    lamps.listen(light, own[light], 2.0**-52)
    assert lamps.said is None  # what the scene says needs no taking over
    lamps.listen(light, pick(light, n), 2.0**-52)
    assert (lamps.said is not None) == taken
    if taken:
        np.testing.assert_allclose(lamps.pick[light], pick(light, n))
        assert not np.allclose(lamps.pick, own)


@pytest.mark.parametrize(
    ("own", "said", "whole"),
    [
        ([0.7, 0.2, 0.06, 0.04], [0.25, 0.25, None, None], [0.25, 0.25, 0.25, 0.25]),
        ([0.7, 0.2, 0.06, 0.04], [0.5, 0.3, None, None], [0.5, 0.3, 0.12, 0.08]),
        ([0.7, 0.2, 0.06, 0.04], [0.5, 0.3, 0.15, None], [0.5, 0.3, 0.15, 0.05]),
        ([0.7, 0.2, 0.06, 0.04], [0.7, 0.2, None, None], None),  # castray's own
        ([0.7, 0.2, 0.06, 0.04], [0.8, 0.2, None, None], None),  # nothing is left for the others
        ([0.7, 0.2, 0.06, 0.04], [0.5, np.nan, None, None], None),
        ([1.0], [0.5], None),
    ],
)
def test_lamps_that_were_never_chosen_share_the_rest_as_the_others_do(own, said, whole):
    light = np.tile(np.flatnonzero([pick is not None for pick in said]), 3)
    pick = np.array([said[k] for k in light])
    for eps in (2.0**-52, 2.0**-23, 1e-6):
        found = choice.said(
            light, pick * (1.0 + eps * np.resize([-4.0, 4.0, 0.0], light.size)), np.array(own), eps
        )
        assert (found is None) == (whole is None)
        if whole:
            np.testing.assert_allclose(found, whole, rtol=0.0, atol=40.0 * eps)


def test_the_environment_may_be_chosen_as_often_as_the_sun():
    settings = tracer.Settings(width=12, height=8, spp=4, strategy="light", precision=64)
    scene = tracer.load("sky")
    own = Evidence(gather(scene, settings)).lamps.pick

    def evenly(scene, hit, u):
        ends = np.r_[0.0, scene.lights.cdf, 1.0]
        lamp = (2.0 * u[0]).astype(int)
        first = ends[lamp] + (2.0 * u[0] - lamp) * np.diff(ends)[lamp]
        light = steps.light_point(scene, hit, np.stack((first, u[1], u[2])))
        return light._replace(pick=np.full(lamp.shape, 0.5), pdf=light.pdf / light.pick * 0.5)

    trace = gather(scene, settings, replace(steps.RIGHT, light_point=evenly))
    assert [f.rule for f in tracer.examine(trace).causes] == ["pdf-of-environment"]
    trace.tables["escape"].columns["pdf_light"] *= 0.5 / own[0]
    assert not tracer.examine(trace).causes


def test_null_stands_for_no_shape_in_whichever_lines_it_is(read):
    def unblocked(event):
        return event | {"blocker": None, "visible": True} if event["kind"] == "light" else event

    log = read(unblocked)
    assert not log.read.mistaken and (log.trace.tables["light"]["blocker"] == -1).all()
