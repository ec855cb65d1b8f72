"""Logs of other tracers, line by line."""

import json

import numpy as np
import pytest
from logs import FACTOR, HEADER, INNER, OUTER, write_log
from suite import castray

import tracer
from tracer.events import BOUNCE, HIT, KINDS, LIGHT, ROULETTE
from tracer.trace import gather
from tracer.trace.jsonl import plain, read_log, reading, schema_text
from tracer.trace.jsonl.schema import call_fields


@pytest.fixture(scope="module")
def cornell():
    return tracer.load("cornell")


@pytest.fixture
def written(tmp_path):
    def write(*lines, end="\n", head=HEADER):
        return write_log(tmp_path / "mine.jsonl", *lines, end=end, head=head)

    return write


def test_calls_become_the_events_of_a_path(written, cornell):
    trace = read_log(written(INNER, OUTER), cornell).trace
    assert {name: table.path.size for name, table in trace.tables.items()} == {
        "camera": 1, "hit": 2, "light": 2, "bounce": 1, "roulette": 2, "escape": 0, "end": 1,
    }  # fmt: skip
    order = [(table.step[k], name) for name, table in trace.tables.items() for k in range(table.step.size)]
    assert [name for _, name in sorted(order)] == [
        "camera", "hit", "light", "bounce", "roulette", "hit", "light", "roulette", "end",
    ]  # fmt: skip
    assert (trace.paths["x"], trace.paths["y"], trace.paths["vertices"]) == (3, 5, 2)
    names = [cornell.shapes[cornell.shape_of[k]].name for k in trace.tables["hit"]["primitive"]]
    assert names == ["floor", "ceiling"]


def test_throughput_and_contributions_are_rebuilt_from_what_calls_return(written, cornell):
    trace = read_log(written(OUTER, INNER), cornell).trace
    beta = trace.tables["roulette"]["beta"]
    np.testing.assert_allclose(beta[:, 0], FACTOR, rtol=1e-6)
    np.testing.assert_allclose(trace.tables["bounce"]["beta"][:, 0], FACTOR * 0.8, rtol=1e-6)
    total = sum(trace.tables[kind]["contribution"].sum(axis=1) for kind in ("hit", "light"))
    np.testing.assert_allclose(total, trace.paths["radiance"][:, 0], rtol=1e-6)
    np.testing.assert_allclose(trace.tables["hit"]["returned"][:, 1], INNER["returned"], rtol=1e-6)


def test_a_roulette_that_is_not_paid_for_shows_as_such(written, cornell):
    unpaid = OUTER | {"indirect": (FACTOR * 0.8 * INNER["returned"]).tolist()}
    trace = read_log(written(unpaid, INNER), cornell).trace
    np.testing.assert_allclose(trace.tables["roulette"]["beta"][:, 0], FACTOR * 0.8, rtol=1e-6)
    np.testing.assert_allclose(trace.tables["bounce"]["beta"][:, 0], FACTOR * 0.8, rtol=1e-6)


@pytest.mark.parametrize(("height", "fires"), [(548.7, False), (548.6, True)])
def test_light_along_the_lamps_plane_may_come_from_either_side(written, cornell, height, fires):
    p, q = np.array([278, height, 559.2]), np.array([278, 548.7, 280])
    d = p - OUTER["ray.o"]
    arrives = (1e-8 * np.array([47.8348 * 0.725, 38.5664 * 0.71, 31.0808 * 0.68])).tolist()
    call = OUTER | {
        "ray.d": (d / np.linalg.norm(d)).tolist(), "hit.p": p.tolist(), "hit.n": [0, 0, -1],
        "light.q": q.tolist(), "light.pdf_area": 1 / 13650, "direct": arrives, "indirect": [0, 0, 0],
        "returned": arrives, "roulette.survived": False,
    }  # fmt: skip
    log = read_log(written(call, head=HEADER | {"digits": 6}), cornell)
    said = [f.rule for f in tracer.examine(log.trace).findings]
    assert said == (["light-term"] if fires else [])


def test_what_is_worked_out_is_not_taken_for_recorded(written, cornell):
    trace = read_log(written(OUTER, INNER), cornell).trace
    assert {"hit.primitive", "bounce.f", "bounce.cos"} <= trace.rebuilt
    assert not {"hit.p", "hit.n", "bounce.wi", "bounce.pdf", "roulette.probability"} & trace.rebuilt


def test_nested_calls_say_the_same(written, cornell):
    own = ("path", "x", "y", "sample", "call", "parent")
    outer = {name: value for name, value in OUTER.items() if name not in ("call", "parent")}
    inner = {name: value for name, value in INNER.items() if name not in own}
    one = read_log(written(outer | {"child": inner}), cornell).trace
    other = read_log(written(OUTER, INNER), cornell).trace
    same(one, other)


def same(one, other):
    for name, table in one.tables.items():
        beside = other.tables[name]
        assert table.columns.keys() == beside.columns.keys()
        np.testing.assert_array_equal(table.path, beside.path)
        np.testing.assert_array_equal(table.step, beside.step)
        for field, column in table.columns.items():
            np.testing.assert_array_equal(column, beside.columns[field], f"{name}.{field}")


@pytest.mark.parametrize("precision", [32, 64])
def test_events_of_castray_itself_come_back_as_they_went(tmp_path, precision):
    scene = tracer.load("cornell_glass")
    settings = tracer.Settings(width=4, height=3, spp=2, precision=precision, max_depth=6)
    trace = gather(scene, settings)
    path = tmp_path / "own.jsonl"
    with open(path, "w", encoding="utf-8") as file:
        head = {
            "castray": 1,
            "bits": precision,
            "digits": 17,
            "spp": 2,
            "max_depth": 6,
            "width": 4,
            "height": 3,
        }
        print(json.dumps(head | {"integrator": "path"}), file=file)
        for y in range(3):
            for x in range(4):
                record = tracer.inspect(scene, settings, x, y).as_dict(scene.at(settings))
                for sample in record["samples"]:
                    for event in sample["events"]:
                        place = {"x": x, "y": y, "sample": sample["sample"]}
                        print(json.dumps(place | event), file=file)
    log = read_log(path, scene)
    assert not log.read.mistaken and log.trace.settings == settings.at_size_of(scene)
    for kind in KINDS:
        table, own = log.trace.tables[kind.name], trace.tables[kind.name]
        np.testing.assert_array_equal(table.path, own.path)
        np.testing.assert_array_equal(table.step, own.step)
        for name, column in own.columns.items():
            assert table[name] is not None or not own.path.size
            if own.path.size:
                np.testing.assert_array_equal(table[name], column, f"{kind.name}.{name}")
    for name, column in trace.paths.items():
        np.testing.assert_array_equal(log.trace.paths[name], column, name)


def turned(names, calls):
    return [call | {name: [-v for v in call[name]] for name in names if name in call} for call in calls]


@pytest.mark.parametrize(
    ("declared", "names"),
    [({"wi": "inward"}, ["bounce.wi"]), ({"wo": "inward"}, ["hit.wo"]), ({"n": "flipped"}, ["hit.n"])],
)
def test_declared_conventions_are_converted(written, cornell, declared, names):
    calls = [call | {"hit.wo": [-v for v in call["ray.d"]]} for call in (OUTER, INNER)]
    right = read_log(written(*calls), cornell).trace
    same(read_log(written(*turned(names, calls), head=HEADER | declared), cornell).trace, right)


def many(calls, count=32):
    for k in range(count):
        yield from (call | {"path": k, "x": 3 + k, "sample": k} for call in calls)


@pytest.mark.parametrize(
    ("names", "told"),
    [
        (["hit.wo"], 'your wo points into the surface at every vertex: declare "wo": "inward"'),
        (["bounce.wi"], 'your wi points into the surface at every vertex: declare "wi": "inward"'),
        (["hit.n"], 'your n is turned round at every vertex: declare "n": "flipped"'),
    ],
)
def test_a_wrong_convention_is_told(written, cornell, names, told):
    calls = [call | {"hit.wo": [-v for v in call["ray.d"]]} for call in (OUTER, INNER)]
    notes = read_log(written(*many(turned(names, calls))), cornell).notes
    assert any(told in note for note in notes), notes
    assert not any("declare" in note for note in read_log(written(*many(calls)), cornell).notes)


def test_units_are_converted_and_a_wrong_one_is_told(written, cornell):
    metres = [
        call | {name: [v / 1000 for v in call[name]] for name in ("ray.o", "hit.p")}
        for call in (OUTER, INNER)
    ]
    right = read_log(written(OUTER, INNER), cornell).trace
    scaled = read_log(written(*metres, head=HEADER | {"unit": 1000}), cornell).trace
    np.testing.assert_allclose(scaled.tables["hit"]["p"], right.tables["hit"]["p"], rtol=1e-6)
    with pytest.raises(tracer.TracerError, match="unit: 'feet' is neither"):
        read_log(written(*metres, head=HEADER | {"unit": "feet"}), cornell)
    wrong = read_log(written(*many(metres)), cornell)
    assert any('declare "unit": 1000' in note for note in wrong.notes), wrong.notes
    assert read_log(written(*many([OUTER, INNER]), head=HEADER | {"unit": "mm"}), cornell).notes == ()


@pytest.mark.parametrize("word", ["NaN", "nan", "-nan", "-nan(ind)", "1.#QNAN", '"NaN"', "null"])
def test_numbers_that_are_none_are_read_in_any_spelling(written, cornell, word):
    line = json.dumps(OUTER).replace('"direct": [0.25', f'"direct": [{word}')
    log = read_log(written(line, INNER), cornell)
    assert not log.read.mistaken
    assert np.isnan(log.trace.tables["light"]["contribution"][0, 0])


@pytest.mark.parametrize("word", ["inf", "Infinity", "1.#INF", '"inf"', '"Infinity"'])
def test_infinity_is_read_in_any_spelling(written, cornell, word):
    line = json.dumps(OUTER).replace('"direct": [0.25', f'"direct": [{word}')
    assert read_log(written(line, INNER), cornell).trace.tables["light"]["contribution"][0, 0] == np.inf


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"hit.p": "near"}, 'line 3: hit.p: "near" is not a list of 3 numbers'),
        ({"hit.p": [1, 2]}, "line 3: hit.p: [1, 2] is not a list of 3 numbers"),
        ({"hit.n": [1, "two", 3]}, 'line 3: hit.n: "two" is not a number'),
        ({"x": -1}, "line 3: x: -1 is not a whole number from 0 to 65534"),
        ({"x": 1.5}, "line 3: x: 1.5 is not a whole number from 0 to 65534"),
        ({"hit.primitive": 99999}, "line 3: hit.primitive: 99999 is not a whole number from -1 to 26"),
        ({"roulette.survived": 2}, "line 3: roulette.survived: 2 is neither true nor false"),
        ({"kind": "jump"}, "line 3: kind: 'jump' is not known"),
    ],
)
def test_a_mistake_has_its_line_and_field(written, cornell, change, told):
    log = read_log(written(OUTER, INNER | {"path": 1, "call": 0, "parent": -1} | change), cornell)
    assert log.read.mistaken == 1
    assert str(log.mistakes[0]).startswith(told)
    assert log.trace.size == 1  # what is right is kept


def test_a_line_that_is_no_json_is_told_and_a_cut_one_left_out(written, cornell):
    log = read_log(written(OUTER, INNER, '{"x": 1,,}', '{"path": 1, "x"', end=""), cornell)
    assert str(log.mistakes[0]).startswith("line 4: not JSON")
    assert "the last line ends in its middle: it is left out" in log.notes
    assert log.trace.size == 1


def test_unknown_fields_are_told_once(written, cornell):
    log = read_log(written(OUTER | {"colour": 1}, INNER | {"colour": 2}), cornell)
    assert [note for note in log.notes if "colour" in note] == [
        "'colour' is no field of this format and is left out (first in line 2)"
    ]


@pytest.mark.parametrize(
    ("lines", "told"),
    [
        ([], "empty; the first line of a log is its header"),
        (['{"path": 0}'], "no header; the first line has to be like"),
        (['{"castray": 2}'], "format version 2 is not known; this castray reads 1"),
        (['{"castray": 1, "bits": 16}'], "bits: 16 is not known; choose one of 32, 64"),
        (['{"castray": 1, "hemisphere": "half"}'], "hemisphere: 'half' is not known"),
        (['{"castray": 1, "height": "tall"}'], "height: 'tall' is not a whole number"),
        (["\x89PNG"], "not JSON"),
        (['{"castray": 1}', "[1]"], "no line can be read; line 2: not an object"),
        (['{"castray": 1}', '{"hit.p": [0,0,0], "call": 1, "parent": 0}'], "no path is whole"),
    ],
)
def test_a_file_that_cannot_be_read_is_one_clear_line(tmp_path, cornell, lines, told):
    path = tmp_path / "mine.jsonl"
    path.write_text("\n".join(lines), encoding="utf-8")
    with pytest.raises(tracer.TracerError) as caught:
        read_log(path, cornell)
    assert told in str(caught.value) and "\n" not in str(caught.value)


def test_a_line_without_end_is_refused_before_it_fills_the_memory(tmp_path, cornell):
    path = tmp_path / "long.jsonl"
    with open(path, "wb") as file:
        file.write(json.dumps(HEADER).encode() + b"\n")
        file.truncate(1 << 30)
    with pytest.raises(tracer.TracerError, match="line 2 is longer than 1 MB"):
        read_log(path, cornell)


def test_the_page_names_every_field(cornell):
    page = schema_text()
    for kind in (HIT, LIGHT, BOUNCE, ROULETTE):
        for field in kind.fields:
            assert f"  {kind.name}.{field.name} " in page
    assert page == castray("log", "--schema").stdout


@pytest.mark.slow
def test_the_command_checks_a_log(written):
    path = written(OUTER, INNER, INNER | {"hit.p": 1})
    done = castray("log", path, "--scene", "cornell")
    assert done.returncode == 0 and "1 path, 2 vertices" in done.stdout, done.stdout
    assert "line 4: hit.p: 1 is not a list of 3 numbers" in done.stdout
    document = json.loads(castray("log", path, "--scene", "cornell", "--json").stdout)
    assert document["mistakes"] == [{"line": 4, "field": "hit.p", "what": "1 is not a list of 3 numbers"}]
    done = castray("log", path.parent / "none.jsonl")
    assert done.returncode == 2 and done.stderr.count("\n") == 1


ODD = (
    {"hit.p": [1, 2]}, {"hit.p": [1, 2, "3"]}, {"direct": None}, {"x": 1.5}, {"x": "4"}, {"x": 70000},
    {"roulette.survived": 1}, {"roulette.survived": 2}, {"hit.primitive": 999}, {"colour": [1, 2, 3]},
    {"direct": [1e999, -1e-320, 0.1]}, {"direct": [-0.0, 2**70, 1]}, {"bounce.pdf": True},
)  # fmt: skip
SPELLED = (
    ("[278,", "[NaN,"), ("278", "0278"), ("278", "278."), ("278", "+278"), ("0.8", ".8"), ("110", "11 0"),
    ("110", "1-10"), ("ray.o", "ra.yo"), ("ray.o", "ray.oe"), ('"x": 3', '"x": 3, "x": 4'), ("}", "}}"),
    ("278", "2.78e2"), ("278", "278E0"), ('"x": 3', '"x": '), ("[278,", "[278,,"), ("[0, 1, 0]", "[]"),
)  # fmt: skip


def test_lines_read_together_say_what_each_says_alone(written, cornell, monkeypatch):
    monkeypatch.setattr("tracer.trace.jsonl.content.SHOWN", 1 << 30)
    rng = np.random.default_rng(3)
    lines = []
    for k in range(20):
        for call in (OUTER, INNER):
            shaken = {name: rng.normal(size=3).tolist() for name in ("direct", "returned")}
            lines.append(json.dumps(call | {"path": k, "x": k} | shaken))
        lines.append(json.dumps(OUTER | {"path": k} | ODD[k % len(ODD)]))
        lines.append(json.dumps(OUTER | {"path": k}).replace(*SPELLED[k % len(SPELLED)], 1))
        lines.append(json.dumps({"kind": "hit", "x": k % 7, "y": 2, "p": [0.1 * k, 1, 2], "t": k}))
    with_kind = [line for line in lines if '"kind": "hit", "x"' in line]
    calls = [line for line in lines if '"kind"' not in line or "ray.o" in line]
    for part in (calls, with_kind + ['{"kind": "hite", "x": 1}', '{"kind": "hit", "x": null}']):
        path = written(*part)
        monkeypatch.setattr(plain, "LEAST", 1 << 30)
        alone = lines_of(path, cornell)
        for block, least in ((1 << 11, 1), (1 << 15, 3)):
            monkeypatch.setattr(plain, "BLOCK", block)
            monkeypatch.setattr(plain, "LEAST", least)
            together = lines_of(path, cornell)
            assert (together.lines, together.mistaken, together.unknown) == (
                alone.lines, alone.mistaken, alone.unknown,
            )  # fmt: skip
            assert set(map(str, together.mistakes)) == set(map(str, alone.mistakes))
            for kind, columns in alone.columns.items():
                np.testing.assert_array_equal(together.columns[kind].line, columns.line)
                assert together.columns[kind].values.keys() == columns.values.keys()
                for name, column in columns.values.items():
                    other = together.columns[kind].values[name]
                    assert other.dtype == column.dtype
                    np.testing.assert_array_equal(other, column, name)
                    np.testing.assert_array_equal(together.columns[kind].given[name], columns.given[name])


def test_plain_lines_need_no_care(written, monkeypatch):
    path = written(*many([OUTER, INNER]))
    monkeypatch.setattr(plain, "BLOCK", 1 << 10)
    reader = plain.Plain({None: call_fields()})
    lines = path.read_bytes().splitlines()[1:]
    monkeypatch.setattr(plain, "LEAST", 32)
    found, left = reader.read(lines)
    assert left == [] and sum(rows.size for _, rows, _ in found) == len(lines)


def lines_of(path, scene):
    return reading.lines.read(path, reading._tables(scene))
