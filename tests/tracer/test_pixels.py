"""A pixel of a trace is what `tracer.inspect` gives of it, and its picture what `tracer.render` gives."""

from dataclasses import replace

import numpy as np
import pytest

import tracer
from tracer.trace import gather, pixels
from tracer.trace.lattice import lattice_of

SETTINGS = tracer.Settings(width=8, height=8, spp=3, max_depth=5)


@pytest.fixture(scope="module", params=["cornell_unit", "coloured_glass"])
def traced(request):
    """A scene and the trace of a small picture of it."""
    scene = tracer.load(request.param)
    return scene, gather(scene, SETTINGS)


def test_a_pixel_of_a_trace_has_the_paths_that_inspect_traces_again(traced):
    scene, trace = traced
    for x, y in ((2, 5), (6, 3)):
        found, again = pixels.pixel(trace, x, y), tracer.inspect(scene, SETTINGS, x, y)
        assert found.as_dict(scene) == again.as_dict(scene)


def test_the_picture_of_a_trace_is_what_render_gives_up_to_rounding(traced):
    scene, trace = traced
    found, rendered = pixels.picture(trace), tracer.render(scene, SETTINGS)
    assert np.allclose(found.rgb, rendered.rgb, rtol=1e-6)
    assert np.allclose(found.variance, rendered.variance, rtol=1e-5, atol=1e-9)


def test_events_are_numbered_without_gaps_whatever_was_left_out(traced):
    _, trace = traced
    tables = dict(trace.tables)
    tables["light"] = tables["light"].take(slice(0, 0))
    sparse = replace(trace, tables=tables)
    dense = pixels.without_gaps(sparse)
    for path in pixels.pixel(dense, 2, 5).paths:
        assert [event.step for event in path.events] == list(range(len(path.events)))
        assert "light" not in {event.kind.name for event in path.events}


def test_the_place_of_a_finding_is_where_its_event_comes_without_the_gaps(traced):
    _, trace = traced
    trace = trace.take(trace.paths["sample"] != 0)
    sparse = replace(trace, tables=trace.tables | {"light": trace.tables["light"].take(slice(0, 0))})
    shown = pixels.pixel(pixels.without_gaps(sparse), 2, 5)
    for number, path in enumerate(pixels.pixel(trace, 2, 5).paths):
        for event in (event for event in path.events if event.kind.name != "light"):
            first = {"x": 2, "y": 5, "sample": path.sample, "step": event.step}
            x, y, there, step = pixels.place(sparse, first)
            assert (x, y, there) == (2, 5, number)
            assert (shown.paths[there].events[step].kind, shown.paths[there].events[step].depth) == (
                event.kind,
                event.depth,
            )
        assert pixels.place(sparse, first | {"step": None})[3] is None


def test_what_was_not_recorded_is_blank(traced):
    _, trace = traced
    hits = trace.tables["hit"]
    less = {name: column for name, column in hits.columns.items() if name not in ("pdf_light", "primitive")}
    table = replace(hits, columns=less)
    event = pixels.pixel(replace(trace, tables=trace.tables | {"hit": table}), 2, 5).paths[0].events[1]
    assert np.isnan(event.values["pdf_light"]) and event.values["primitive"] == -1


def test_a_pixel_without_a_path_is_refused(traced):
    _, trace = traced
    with pytest.raises(tracer.TracerError, match="pixel 2 5: no path of it was recorded"):
        pixels.pixel(trace.take(trace.paths["y"] != 5), 2, 5)


@pytest.mark.parametrize(("columns", "rows", "count"), [(4, 2, (2, 4)), (2, 3, (4, 3))])
def test_a_pixel_in_so_many_stands_for_what_is_around_it(traced, columns, rows, count):
    _, trace = traced
    x, y = trace.paths["x"], trace.paths["y"]
    lattice = lattice_of(trace.take((x % columns == 0) & (y % rows == 1)))
    assert (lattice.first, lattice.step, lattice.count) == ((0, 1), (columns, rows), count)
    height, width = trace.settings.height, trace.settings.width
    values = np.arange(height * width).reshape(height, width)
    shown = lattice.spread(values)
    for at in np.ndindex(height, width):
        column, row = lattice.nearest(at[1], at[0])
        assert column % columns == 0 and row % rows == 1 and shown[at] == values[row, column]
        if at[0] % rows == 1 and at[1] % columns == 0:
            assert (column, row) == at[::-1]


@pytest.mark.parametrize(
    "kept", [lambda x, y: y != 5, lambda x, y: x % 2 == 0, lambda x, y: (x == 1) & (y == 1)]
)
def test_pixels_that_are_no_lattice_stand_for_themselves(traced, kept):
    """A row that is lost, columns alone, one pixel."""
    _, trace = traced
    assert lattice_of(trace.take(kept(trace.paths["x"], trace.paths["y"]))) is None
