"""A path is a chain, its throughput a product, its pixel a mean: done once more from the recorded numbers."""

import numpy as np

import tracer
from tracer.scene_file.change import changed

HALF = 0.5  # what is left of the albedo of floor, ceiling and box in the question
NAMES = ("first_path", "second_path", "third_path", "fourth_path")


def experiment(run):
    """Radiances of the red channel, and how much of it came by one event."""
    pixel, path = run.pixel(run.lesson.moments["start"].x, run.lesson.moments["start"].y), run.path("start")
    red = [float(each.radiance[0]) for each in pixel.paths]
    brought = float(run.event("brightest")["contribution"][0])
    joins(path), grows(path)
    assert np.isclose(np.mean(red), pixel.value[0], rtol=1e-6)
    assert np.isclose(brought + run.event("first")["contribution"][0], path.radiance[0], rtol=1e-6)
    assert 1.0 / 3.0 < brought / np.sum(red) < 0.5  # "more than a third"
    lost = run.event("mistake")
    from_vertex = np.linalg.norm(np.subtract(lost["p"], run.path("mistake").events[1].values["p"]))
    assert from_vertex > 2.0 * lost["t"]
    return dict(zip(NAMES, red, strict=True)) | {
        "paths": len(red),
        "mean": np.mean(red),
        "sum": np.sum(red),
        "brought": brought,
        "share": brought / np.sum(red),
        "of_path": brought / red[run.lesson.moments["start"].path],
        "undivided": brought / np.mean(red),
        "evenly": 1.0 / len(red),
        "left": halved(run) / brought,
        "once": HALF,
        "twice": HALF**2,
        "four_times": HALF**4,
        "from_vertex": from_vertex,
    }


def joins(path):
    """Each point is the one before, a way t along the direction taken there."""
    start, way = path.events[0].values["o"], path.events[0].values["d"]
    for event in path.events[1:]:
        if event.kind.name == "hit":
            p = event.values["p"]
            assert np.allclose(p, start + event.values["t"] * way, atol=1e-5)
            start = p
        elif event.kind.name == "bounce":
            way = event.values["wi"]


def grows(path):
    """Throughput after each bounce is that before it, times f cos / pdf."""
    for event in path.events:
        if event.kind.name == "bounce":
            it = event.values
            assert np.allclose(it["beta"], it["beta_before"] * it["f"] * it["cos"] / it["pdf"], rtol=1e-5)


def halved(run):
    """What the brightest event brings when the white of the scene reflects half as much."""
    scene, at = run.scene(), run.lesson.moments["brightest"]
    white = scene.definition.bsdfs["white"].reflectance[:, 0]
    darker = changed(scene, {"white.reflectance": [float(HALF * albedo) for albedo in white]})
    record = tracer.inspect(darker, run.settings(), at.x, at.y)
    return float(record.paths[at.path].events[at.event].values["contribution"][0])
