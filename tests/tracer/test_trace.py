"""A recording of many paths in columns."""

from dataclasses import replace

import numpy as np
import pytest

import tracer
from tracer import trace
from tracer.events import KINDS

SMALL = {"width": 6, "height": 5, "spp": 3, "max_depth": 6}


@pytest.fixture(params=["cornell_unit", "coloured_glass", "sky"])
def scene(request):
    return tracer.load(request.param)


def event_of(found, kind, row):
    return {f.name: found.column(kind.name, f.name)[..., row] for f in kind.fields}


@pytest.mark.slow
@pytest.mark.parametrize("precision", [32, 64])
def test_a_trace_holds_of_every_event_what_inspect_shows(scene, precision):
    settings = tracer.Settings(precision=precision, **SMALL)
    found = trace.gather(scene, settings)
    rows = {kind.name: 0 for kind in KINDS}
    for pixel in range(SMALL["width"] * SMALL["height"]):
        x, y = pixel % SMALL["width"], pixel // SMALL["width"]
        for path in tracer.inspect(scene, settings, x, y).paths:
            for event in path.events:
                table, row = found.tables[event.kind.name], rows[event.kind.name]
                rows[event.kind.name] += 1
                number = pixel * settings.spp + path.sample
                assert (table.path[row], table.step[row], table.depth[row]) == (
                    number,
                    event.step,
                    event.depth,
                )
                for name, value in event_of(found, event.kind, row).items():
                    np.testing.assert_array_equal(value, event.values[name], f"{event.kind.name} {name}")
    assert rows == {name: table.path.size for name, table in found.tables.items()}


def test_paths_are_rows_in_the_order_of_pixel_and_sample(scene):
    settings = tracer.Settings(**SMALL)
    paths = trace.gather(scene, settings).paths
    number = (paths["y"] * SMALL["width"] + paths["x"]) * settings.spp + paths["sample"]
    np.testing.assert_array_equal(number, np.arange(number.size))
    picture = tracer.render(scene, settings)
    mean = paths["radiance"].astype(np.float64).reshape(3, SMALL["height"], SMALL["width"], 3).mean(axis=-1)
    np.testing.assert_allclose(mean, picture.rgb.transpose(2, 0, 1), rtol=1e-6)


def test_parts_joined_are_the_whole(scene):
    settings = tracer.Settings(**SMALL)
    whole = trace.gather(scene, settings)
    joined = trace.join(trace.parts(scene, settings, lanes=12))
    for name, table in whole.tables.items():
        other = joined.tables[name]
        np.testing.assert_array_equal(table.path, other.path)
        np.testing.assert_array_equal(table.step, other.step)
        for column in table.columns:
            np.testing.assert_array_equal(table[column], other[column])


def test_some_paths_are_those_of_the_whole_numbered_afresh(scene):
    whole = trace.gather(scene, tracer.Settings(**SMALL))
    some = whole.take(whole.paths["vertices"] > 2)
    assert 0 < some.size < whole.size and (some.paths["vertices"] > 2).all()
    for name, table in some.tables.items():
        assert table.path.max(initial=-1) < some.size, name
    np.testing.assert_array_equal(
        some.hit_of("bounce"), np.arange(some.tables["hit"].path.size)[some.hit_of("bounce")]
    )


def test_an_event_knows_the_vertex_it_belongs_to(scene):
    found = trace.gather(scene, tracer.Settings(**SMALL))
    hits = found.tables["hit"]
    for kind in ("bounce", "roulette"):
        table, hit = found.tables[kind], found.hit_of(kind)
        np.testing.assert_array_equal(hits.path[hit], table.path)
        np.testing.assert_array_equal(hits.depth[hit], table.depth)
    assert (found.hit_of("camera") == -1).all()


def test_what_was_not_recorded_is_not_there(scene):
    found = trace.gather(scene, tracer.Settings(**SMALL))
    del found.tables["bounce"].columns["wi"]
    assert found.column("bounce", "wi") is None
    assert found.column("bounce", "D") is None  # made of wi
    assert found.column("bounce", "pdf") is not None


@pytest.mark.parametrize(
    ("kind", "name", "blank"),
    [
        ("light", "F", np.nan),
        ("bounce", "G1", np.nan),
        ("light", "blocker", -1),
        ("light", "cos_light", None),
    ],
)
def test_an_event_whose_surface_was_not_recorded_has_nothing_that_is_made_of_a_surface(kind, name, blank):
    source = tracer.load("cornell_unit").definition.source[0]
    metal = {"type": "roughconductor", "alpha": 0.3}
    scene = tracer.load_dict(source | dict.fromkeys(("white", "green", "red"), metal))
    found = trace.gather(scene, tracer.Settings(**SMALL))
    hits = found.tables["hit"]
    lost = np.unique(found.tables[kind].path)[::3]  # paths whose hits are left out
    kept = hits.take(~np.isin(hits.path, lost))
    partly = replace(found, tables=found.tables | {"hit": kept})
    whole, column = found.column(kind, name), partly.column(kind, name)
    astray = np.isin(found.tables[kind].path, lost)
    assert 0 < np.count_nonzero(astray) < astray.size
    np.testing.assert_array_equal(column[..., ~astray], whole[..., ~astray])
    expected = whole[..., astray] if blank is None else np.full_like(whole[..., astray], blank)
    np.testing.assert_array_equal(column[..., astray], expected)
    assert column.dtype == whole.dtype
