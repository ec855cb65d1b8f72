"""Queries on a recording: right answers, one clear line for what is wrong, no way out of the recording."""

import re
import time

import numpy as np
import pytest
from cases import slow_but

import tracer
from lessons import zoo
from tracer.trace import asker, folder, query, views
from tracer.trace.breakpoints import BREAKPOINTS, condition

SETTINGS = tracer.Settings(width=8, height=7, spp=6, max_depth=6)


def recorded(path, name="cornell_unit", settings=SETTINGS, level="events"):
    scene = tracer.load(name)
    tracer.record(scene, settings, path, level, steps=zoo.planted(settings))
    return path


@pytest.fixture(scope="module")
def box(tmp_path_factory):
    return recorded(tmp_path_factory.mktemp("box") / "rec")


def ask(path, text, limit=1000):
    """As asker.ask, in this process: quicker."""
    return query.answer(folder.whole(path), text, limit)


def test_a_condition_finds_the_events_that_numpy_finds(box):
    trace = tracer.read_trace(box)
    light = trace.tables["light"]
    rows = np.flatnonzero((light.depth >= 2) & (light["pdf"] < 0.3))
    found = ask(box, "kind = 'light' AND depth >= 2 AND pdf < 0.3")
    assert found["events"] == rows.size > 0
    assert [p["path"] for p in found["found"]] == np.unique(light.path[rows]).tolist()
    first = light.path[rows[0]]
    at = found["found"][0]
    assert (at["x"], at["y"], at["sample"]) == tuple(trace.paths[n][first] for n in ("x", "y", "sample"))
    assert (at["step"], at["depth"], at["kind"]) == (light.step[rows[0]], light.depth[rows[0]], "light")
    assert sum(row[2] for row in found["mask"]) == found["paths"]


def test_a_rectangle_of_pixels_is_asked_for_by_its_sides(box):
    found = ask(box, "x BETWEEN 2 AND 4 AND y < 3 AND kind = 'camera'")
    assert found["pixels"] == 3 * 3 and found["paths"] == 3 * 3 * SETTINGS.spp
    assert {(x, y) for x, y, _ in found["mask"]} == {(x, y) for x in (2, 3, 4) for y in (0, 1, 2)}


@pytest.mark.slow
@pytest.mark.parametrize(("name", "precision"), [("cornell_unit", 64), ("coloured_glass", 32), ("sky", 32)])
def test_every_column_says_what_the_trace_says(tmp_path, name, precision):
    settings = tracer.Settings(width=4, height=3, spp=3, max_depth=6, precision=precision)
    path = recorded(tmp_path / "rec", name, settings)
    trace = tracer.read_trace(path)
    for column, (axes, kinds) in views.fields().items():
        for kind, field in kinds.items():
            parts = [f'"{column}".{axis}' for axis in axes[: max(1, len(field.shape and axes))]] or [
                f'"{column}"'
            ]
            rows = ask(
                path,
                f"SELECT {', '.join(parts)} FROM events WHERE kind = '{kind}' ORDER BY path, step",
                10**6,
            )
            if field in trace_kind(kind).fields:
                right = trace.column(kind, column)
            else:
                right = trace.column("hit", column).take(trace.hit_of(kind), axis=-1)
            _same(np.atleast_2d(right).T.tolist(), rows["rows"], field, path, f"{kind} {column}")


def trace_kind(name):
    return next(kind for kind in views.KINDS if kind.name == name)


def _same(right, shown, field, path, what):
    names = folder.opened(path).header["names"]
    table = names.get(field.domain if field.domain in ("shape", "bsdf", "light") else field.name)
    assert len(right) == len(shown), what
    for a, b in zip(right, shown, strict=True):
        if table is not None:
            assert b == [None if a[0] < 0 else table[int(a[0])]], what
        elif field.domain == "flag":
            assert b == [bool(a[0])], what
        else:
            assert np.allclose(a, [float("nan") if v is None else float(v) for v in b], 1e-4, 1e-5, True), (
                what
            )


def test_vectors_have_macros_and_vertices_are_carried_along(box):
    assert ask(box, "kind = 'bounce' AND abs(abs(dot(n, wi)) - cos) > 1e-4")["events"] == 0
    assert ask(box, "kind = 'hit' AND abs(length(n) - 1) > 1e-4")["events"] == 0
    assert ask(box, "previous = 'hit' AND kind = 'light' AND shape = 'floor'")["events"] > 0
    assert ask(box, "kind = 'camera'")["events"] == 8 * 7 * 6


def test_a_select_gives_rows(box):
    found = ask(box, "SELECT count(*) AS n, sum(vertices) AS v FROM paths", 5)
    assert found == {
        "columns": ["n", "v"],
        "rows": [[8 * 7 * 6, tracer.read_trace(box).vertices]],
        "more": False,
    }
    assert ask(box, "WITH a AS (SELECT 1 AS one) SELECT one FROM a")["rows"] == [[1]]
    assert ask(box, "SELECT path FROM paths", 3)["more"]


NO_QUERIES = [
    "COPY (SELECT 1) TO 'out.csv'",
    "COPY paths TO 'rec/out.parquet'",
    "ATTACH 'other.db'",
    "PRAGMA database_list",
    "SET threads = 1",
    "INSTALL httpfs",
    "CALL enable_logging('QueryLog')",
    "CREATE TABLE t AS SELECT 1",
    "DROP VIEW events",
    "EXPORT DATABASE 'all'",
    "EXPLAIN SELECT 1",
    "SELECT 1; SELECT 2",
    "depth >= 2; DROP VIEW events",
    "SELECT * FROM read_csv('{other}')",
    "SELECT * FROM read_parquet('{other}')",
    "SELECT * FROM read_text('{other}')",
    "SELECT * FROM read_blob('{other}')",
    "SELECT * FROM '{other}'",
    "SELECT * FROM glob('{folder}/*')",
    "SELECT * FROM parquet_metadata('{other}')",
    "SELECT * FROM sniff_csv('{other}')",
    "SELECT * FROM query('SELECT 1')",
    "SELECT * FROM duckdb_settings()",
    "SELECT * FROM enable_logging(storage = 'file', storage_path = '{folder}/log')",
    "SELECT getenv('HOME')",
    "SELECT write_log('x')",
    "SELECT current_setting('home_directory')",
    "depth IN (SELECT 1 FROM read_text('{other}'))",
    "1 = 1) UNION SELECT content, 1 FROM read_text('{other}') WHERE (1 = 1",
    "SELECT other FROM other",
]


@pytest.mark.parametrize("text", slow_but(NO_QUERIES, *NO_QUERIES[::4]))
def test_a_query_can_neither_change_nor_read_anything_else(box, tmp_path, monkeypatch, text):
    monkeypatch.chdir(tmp_path)
    secret = tmp_path / "other.parquet"
    other = {"secret": np.arange(3)}
    from tracer.trace import parquet

    parquet.write(secret, other)
    before = {p: p.stat().st_mtime_ns for root in (tmp_path, box) for p in root.rglob("*")}
    with pytest.raises(tracer.TracerError, match="^query: ") as refused:
        ask(box, text.format(other=secret, folder=tmp_path))
    assert "\n" not in str(refused.value)
    assert before == {p: p.stat().st_mtime_ns for root in (tmp_path, box) for p in root.rglob("*")}


def test_what_only_duckdb_can_refuse_is_refused_too(box, tmp_path, monkeypatch):
    """The wall behind the first: were no function looked for, files would still be out of reach."""
    from tracer.trace import parquet

    parquet.write(tmp_path / "other.parquet", {"secret": np.arange(3)})
    monkeypatch.setattr(query, "_check_functions", lambda connection, text: None)
    for call in ("read_parquet", "read_text", "parquet_metadata", "glob"):
        with pytest.raises(tracer.TracerError, match="Cannot access"):
            ask(box, f"SELECT * FROM {call}('{tmp_path}/other.parquet')")


@pytest.mark.parametrize(
    "bomb",
    [
        "SELECT count(*) FROM range(1000000000000) a, range(1000000000000) b",
        "WITH RECURSIVE t(a) AS (SELECT 1 UNION ALL SELECT a + 1 FROM t) SELECT max(a) FROM t",
        "SELECT list_sum(range(1000000000))",
        "SELECT repeat('x', 2000000000) || repeat('y', 2000000000)",
        "SELECT string_agg(i) FROM range(1000000000000) t(i)",
    ],
)
@pytest.mark.slow
def test_a_bomb_ends(box, bomb):
    began = time.perf_counter()
    with pytest.raises(tracer.TracerError, match="took longer|too much memory|out of memory|query: "):
        asker.ask(box, bomb, seconds=4.0)
    assert time.perf_counter() - began < 120


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("depth > 1 AND pdff < 1", ("pdff", "character 15", "did you mean pdf", "columns: kind")),
        ("depth >= 2 AND (", ("syntax", "columns: kind")),
        ("n.q < 1", ('"q"', "character 3")),
        ("dott(n, wi) > 0", ("dott", "character 1")),
        ("SELECT pdff FROM events", ("pdff", "character 8")),
        ("SELECT pdf FROM event", ("event", "did you mean events", "views: paths, events")),
        ("", ("empty",)),
        ("'a' < n", ("query:",)),
    ],
)
def test_a_wrong_query_is_told_where_and_which_columns_there_are(box, text, said):
    with pytest.raises(tracer.TracerError) as refused:
        asker.ask(box, text) if not text else ask(box, text)
    line = str(refused.value)
    assert "\n" not in line and not [word for word in said if word not in line], line


def test_a_name_that_nothing_has_is_told_with_the_nearest(box):
    place = folder.whole(box)
    assert query.strangers(place, "kind = 'light' AND blocker = 'floor'") == []
    ((name, near),) = query.strangers(place, "kind = 'light' AND blocker = 'flor'")
    assert name == "flor" and "floor" in near


def test_where_only_paths_were_recorded_conditions_are_on_paths(tmp_path):
    path = recorded(tmp_path / "rec", level="paths")
    assert ask(path, "vertices > 2")["paths"] == (tracer.read_trace(path).paths["vertices"] > 2).sum()
    with pytest.raises(tracer.TracerError, match="has paths only"):
        ask(path, "pdf < 1")


@pytest.mark.slow
def test_breakpoints_find_what_they_are_for_and_nothing_in_a_right_tracer(box, tmp_path):
    counts = {name: ask(box, condition(name, "events"))["events"] for name in BREAKPOINTS}
    trace = tracer.read_trace(box)
    unlikely = int((trace.tables["roulette"]["probability"] < 0.05).sum())
    assert counts | {"largest": 1} == dict.fromkeys(BREAKPOINTS, 0) | {"largest": 1, "roulette": unlikely}
    brightest = max(
        float((trace.tables[kind]["contribution"].T @ np.array([0.2126, 0.7152, 0.0722])).max(initial=0.0))
        for kind in ("hit", "light", "escape")
    )
    (row,) = ask(box, "SELECT max(luminance(contribution)) FROM events")["rows"]
    assert row[0] == pytest.approx(brightest, rel=1e-5)
    paths = recorded(tmp_path / "paths", level="paths")
    assert ask(paths, condition("largest", "paths"))["paths"] >= 1
    with pytest.raises(tracer.TracerError, match="needs a recording of events"):
        condition("near", "paths")
    with pytest.raises(tracer.TracerError, match="choose one of nan"):
        condition("far", "events")


def spoilt(step, worse):
    """The right steps with what one of them gives made worse."""
    right = getattr(zoo.RIGHT, step)
    return zoo.changed(**{step: lambda *a: worse(right(*a))})


@pytest.mark.parametrize(
    ("name", "step", "worse"),
    [
        ("nan", "light_term", lambda c: c * np.float32("nan")),
        pytest.param("negative", "light_term", lambda c: -c, marks=pytest.mark.slow),
        pytest.param("self", "visibility", lambda seen: seen & False, marks=pytest.mark.slow),
    ],
)
def test_a_breakpoint_fires_where_its_mistake_is_made(tmp_path, name, step, worse):
    tracer.record(
        tracer.load("cornell_unit"), SETTINGS, tmp_path / "rec", "events", steps=spoilt(step, worse)
    )
    assert ask(tmp_path / "rec", condition(name, "events"))["events"] > 0


def test_roulette_that_is_nearly_sure_to_end_stops_a_breakpoint(tmp_path):
    settings = tracer.Settings(width=8, height=7, spp=6, max_depth=6, roulette="0.03")
    path = recorded(tmp_path / "rec", settings=settings)
    assert ask(path, condition("roulette", "events"))["events"] > 0


def test_the_page_of_the_format_has_every_field():
    page = views.schema()
    for kind in views.KINDS:
        assert f"kind {kind.name}: {kind.meaning}" in page
        for field in kind.fields:
            if field.carried:
                assert field.meaning in page, field.name


def test_names_and_meanings_stand_apart_on_the_page():
    listed = views.schema().split("view paths")[1].splitlines()
    begins = {re.match(r"  (\S+|\w+\(.*?\))  +", line).end() for line in listed if line.startswith("  ")}
    assert len(begins) == 1 and "  transmittance.r.g.b  share of" in "\n".join(listed)
