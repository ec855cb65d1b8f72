"""The doctor: right traces break no law, each law has a broken twin, and mistakes are told by their names."""

from dataclasses import replace
from functools import cache
from itertools import combinations

import doctor_paper
import doctor_table
import false_alarms
import numpy as np
import pytest
from cases import slow_but
from mutants import MUTANTS, changed, traced, with_column
from suite import suite_seed

import tracer
from lessons import zoo
from tracer.doctor import LAWS, diagnosis, examine, statistics
from tracer.doctor.diagnosis import Finding
from tracer.doctor.evidence import Evidence
from tracer.events import KINDS
from tracer.trace import gather

SMALL = {"width": 16, "height": 16, "spp": 4}
HOMEWORK = {"hemisphere": "uniform", "roulette": "0.8", "light_sampling": "area"}
kept = cache(traced)


def zoo_trace(*bugs, **options):
    """A small trace with some of the zoo's bugs planted at once, in the scene of the first."""
    first = zoo.ZOO[bugs[0]]
    changes = {name: step for bug in bugs for name, step in zoo.ZOO[bug].changes.items()}
    settings = first.asked(**SMALL | options)
    return gather(tracer.load(first.scene), settings, zoo.changed(**changes))


def fired(diagnosis):
    return {verdict.rule.id for verdict in diagnosis.rules if verdict.state == "fired"}


@pytest.mark.parametrize("name", ["room", "rooms", "glass", "sky", "smooth"])
def test_a_right_trace_breaks_no_law(name):
    diagnosis = examine(kept(name))
    assert not diagnosis.findings
    assert sum(v.state == "clean" for v in diagnosis.rules) > 40


@pytest.mark.slow
@pytest.mark.parametrize("precision", [32, 64])
@pytest.mark.parametrize("options", [{}, HOMEWORK], ids=["default", "homework"])
@pytest.mark.parametrize("scene", tracer.built_in_scenes())
def test_right_tracers_break_no_law_in_any_scene(scene, options, precision):
    loaded = tracer.load(scene)
    for integrator in ("path", "direct", "walk"):
        if integrator == "walk" and loaded.unmeetable:
            continue
        trace = gather(
            loaded, tracer.Settings(integrator=integrator, precision=precision, **SMALL, **options)
        )
        diagnosis = examine(trace)
        assert not diagnosis.findings, diagnosis.findings[0]
        assert sum(v.abstained for v in diagnosis.rules) < 0.02 * sum(v.checked for v in diagnosis.rules)


@pytest.mark.parametrize("rule", MUTANTS)
def test_each_law_has_a_broken_twin(rule):
    name, mutate = MUTANTS[rule]
    assert rule in fired(examine(mutate(kept(name)), only={rule}))


def test_every_law_has_a_mutant():
    assert {rule.id for rule in LAWS} == MUTANTS.keys()
    assert len(LAWS) == len({rule.id for rule in LAWS})


MANY_PATHS = ("D15", "D17", "D18", "B09", "P02", "P03", "F05")  # what no single event shows
ALIKE = {"E04": "E01", "D02": "D01"}  # what no trace tells from another
SQUARE = ("F06",)  # what a square picture does not show
SHOWN = [
    bug
    for bug, entry in zoo.ZOO.items()
    if not entry.only_cost and bug not in (*MANY_PATHS, *SQUARE, "castray")
]


@pytest.mark.slow
@pytest.mark.parametrize("bug", SHOWN)
def test_a_bug_of_the_zoo_is_named_first(bug):
    first = examine(zoo_trace(bug)).findings[0]
    assert first.bug == ALIKE.get(bug, bug)
    assert bug in (first.bug, *first.alike)
    assert first.count > 0 and first.explanation


@pytest.mark.slow
def test_the_abandoned_castray_is_three_mistakes_that_hide_each_other():
    assert {"E01", "D01", "D06"} <= set(examine(zoo_trace("castray")).bugs)


@pytest.mark.slow
@pytest.mark.parametrize("bugs", [b for k in (1, 2, 3) for b in combinations(("E01", "D01", "D06"), k)])
def test_the_three_mistakes_of_castray_are_told_apart_in_any_combination(bugs):
    assert set(examine(zoo_trace(*bugs, spp=8)).bugs) == set(bugs)


@pytest.mark.parametrize("bug", slow_but(("D10", "R01"), "R01"))
def test_a_trace_judged_in_parts_is_judged_as_a_whole(bug, monkeypatch):
    trace = zoo_trace(bug)
    whole = examine(trace)
    monkeypatch.setattr(diagnosis, "_VERTICES", trace.vertices // 5)
    parts = examine(trace)
    assert counts_of(parts) == counts_of(whole)
    assert [(f.rule, f.bug, f.count, f.checked) for f in parts.causes] == [
        (f.rule, f.bug, f.count, f.checked) for f in whole.causes
    ]
    wrong, again = (
        {v.rule.id: list(v.outcome.rows[v.outcome.wrong]) for v in d.rules if v.state == "fired"}
        for d in (whole, parts)
    )
    assert wrong == again
    first = parts.causes[0]
    (path,) = np.flatnonzero(
        np.all([trace.paths[name] == first.first[name] for name in ("x", "y", "sample")], axis=0)
    )
    table = trace.tables[first.first["kind"]]
    assert ((table.path == path) & (table.step == first.first["step"])).sum() == 1


def counts_of(diagnosis):
    return [(v.rule.id, v.state, v.checked, v.failed, v.abstained, v.missing) for v in diagnosis.rules]


def test_what_is_met_from_behind_only_is_doubtful_where_backs_may_be_culled():
    brute = Evidence(zoo_trace("D10")).brute  # the homework's box, in millimetres
    lamp = np.array([[278.0], [548.7], [280.0]])
    lamp, none = np.array([[278.0], [548.6], [280.0]]), np.array([-1])
    within, behind = (np.array(p)[:, None] for p in ((185.0, 80.0, 170.0), (368.0, 10.0, 500.0)))  # the boxes
    for start, sure in ((within, False), (behind, True)):
        assert [v.all() for v in brute.between(start, lamp, none, none, 1e-3)] == [True, True]
        found = brute.between(start, lamp, none, none, 1e-3, front_only=True)
        assert [v.all() for v in found] == [sure, True]


@pytest.mark.parametrize("culled", [False, True])
def test_light_that_passes_a_front_is_a_mistake_whether_backs_are_culled_or_not(culled):
    right = kept("room")
    through = np.ones_like(right.tables["light"]["visible"])
    wrong = replace(with_column(right, "light.visible", through), culled=culled)
    (verdict,) = [v for v in examine(wrong).rules if v.rule.id == "light-visible"]
    assert verdict.failed > 10


def test_several_bugs_at_once_are_told_apart():
    diagnosis = examine(zoo_trace("E01", "D01", "D10", "B12", "R01", "F01"))
    assert set(diagnosis.bugs) == {"E01", "D01", "D10", "B12", "R01", "F01"}


@pytest.mark.slow
def test_which_bug_is_switched_on_is_not_looked_at():
    right, wrong = kept("room"), zoo_trace("D10")
    said = examine(wrong).as_dict()
    for bug in (None, "E01", "D10"):
        swapped = replace(wrong, settings=replace(wrong.settings, bug=bug))
        assert examine(swapped).as_dict() == said
        assert not examine(replace(right, settings=replace(right.settings, bug=bug))).findings


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
def test_a_law_without_its_columns_is_not_testable_and_says_which(kind):
    whole = kept("room")
    for field in (f for f in kind.fields if f.carried):
        place = f"{kind.name}.{field.name}"
        diagnosis = examine(with_column(whole, place, None))
        assert not diagnosis.findings, place
        for verdict in diagnosis.rules:
            if place in verdict.rule.needs:
                assert verdict.state == "not_testable" and place in verdict.missing


def test_a_finding_shows_both_numbers_the_path_and_how_to_see_it():
    diagnosis = examine(zoo_trace("D10"))
    finding = diagnosis.findings[0]
    x, y, sample = (finding.first[name] for name in ("x", "y", "sample"))
    assert f"castray inspect cornell --pixel {x} {y} --sample {sample}" in finding.command
    assert "--integrator direct" in finding.command and "--bug" not in finding.command
    trace = zoo_trace("D10")
    table = trace.tables["light"]
    (path,) = np.flatnonzero(
        (trace.paths["x"] == x) & (trace.paths["y"] == y) & (trace.paths["sample"] == sample)
    )
    (row,) = np.flatnonzero((table.path == path) & (table.step == finding.first["step"]))
    np.testing.assert_array_equal(finding.recorded, table["contribution"][:, row])
    np.testing.assert_allclose(
        np.array(finding.recorded) * float(table["cos"][row]), finding.right, rtol=1e-5
    )


def finding(rule, count, checked):
    place = {"x": 0, "y": 0, "sample": 0, "depth": 0, "kind": "hit", "step": 1}
    return Finding(rule, "", "", "", None, (), count, checked, place, "", None, None, "", None)


@pytest.mark.parametrize(
    ("cause", "other", "follows"),
    [
        (("own-surface", 6), ("on-surface", 1029), None),
        (("own-surface", 900), ("on-surface", 1029), "own-surface"),
        (("light-term", 62), ("finite", 1013), None),
        (("bounce-f", 800), ("directions", 2), None),
        (("bounce-side", 800), ("directions", 2), "bounce-side"),
    ],
)
def test_a_law_follows_only_from_one_that_is_about_it_and_broken_often_enough(cause, other, follows):
    found = {f.rule: f.follows for f in diagnosis.ranked([finding(*cause, 5000), finding(*other, 5000)])}
    assert found == {cause[0]: None, other[0]: follows}


@pytest.mark.slow
def test_normals_of_other_surfaces_are_known_as_such_and_have_no_colours():
    trace = changed(kept("room"), "hit.ng", lambda ng: np.roll(ng, 7, axis=1))
    trace = with_column(trace, "hit.n", trace.tables["hit"]["ng"])
    said = {f.rule: f.explanation for f in examine(trace).findings}
    assert said["normal"] == "recorded are the normals of other surfaces"
    assert not any("red" in words for words in said.values())


@pytest.mark.slow
def test_two_exchanged_channels_of_one_surface_are_told_with_it():
    trace = kept("room")
    hits = trace.tables["hit"]
    wall = trace.scene.shape_of.take(hits["primitive"]) == 3
    light = trace.tables["light"]
    vertex = trace.hit_of("light")
    trace = changed(trace, "light.f", lambda f: f[[1, 0, 2]], wall[vertex] & (light["f"] > 0.0).all(axis=0))
    (said,) = {f.explanation for f in examine(trace).findings if f.rule == "light-f"}
    name = trace.scene.shapes[3].name
    assert said == f"red and green are exchanged; only on {name}"


def test_a_lamps_radiance_that_is_told_for_its_dark_side_but_not_used_is_no_mistake():
    trace = kept("room")
    light = trace.tables["light"]
    behind = (light["nq"] * light["wi"]).sum(axis=0) > 0.01
    told = changed(
        trace, "light.Le", lambda Le: np.float32([[18.387], [13.987], [6.7536]]) + 0.0 * Le, behind
    )
    assert behind.any() and "light-radiance" not in fired(examine(told))
    used = changed(told, "light.contribution", lambda c: c + np.float32(1), behind)
    assert "light-radiance" in fired(examine(used))


def test_what_a_surface_reflects_that_is_told_for_its_back_but_not_used_is_no_mistake():
    trace = kept("room")
    light = trace.tables["light"]
    below = (trace.tables["hit"]["n"][:, trace.hit_of("light")] * light["wi"]).sum(axis=0) < -0.01
    told = changed(trace, "light.f", lambda f: f + np.float32(0.2), below)
    assert below.any() and "light-f" not in fired(examine(told))
    used = changed(told, "light.contribution", lambda c: c + np.float32(1), below)
    assert "light-f" in fired(examine(used))


def test_what_cannot_be_told_has_no_name():
    odd = with_column(
        kept("room"), "light.contribution", kept("room").tables["light"]["contribution"] * np.float32(1.37)
    )
    (finding,) = [f for f in examine(odd).findings if f.rule == "light-term"]
    assert finding.bug is None and finding.count > 0


@pytest.mark.parametrize(
    "options", [{"max_depth": 0}, {"max_depth": 1}, {"max_depth": 2}, {"width": 1, "height": 1, "spp": 1}]
)
def test_traces_with_hardly_an_event_are_judged(options):
    assert not examine(traced("room", **options)).findings
    assert not examine(traced("sky", **options)).findings


MANY = {  # what only many events show: (trace, what is done to it, the rule that fires)
    "film": ("room", "camera.film", lambda film: np.floor(film) + 0.5, "numbers-uniform"),
    "beside": (
        "room",
        "camera.film",
        lambda film: np.floor(film) + np.array([[0.5], [1.0]]) * (film % 1.0),
        "film",
    ),
    "numbers": ("room", "light.u", lambda u: np.sqrt(u), "numbers-uniform"),
    "again": ("room", "light.u", lambda u: u[:, np.arange(u.shape[1]) // 2], "numbers-once"),
    "related": ("room", "bounce.u", lambda u: u[[0, 2, 2]], "numbers-uniform"),
    "lamps": ("lamps", "light.light", lambda light: np.zeros_like(light), "lamp-choice"),
    "directions": ("room", "bounce.wi", lambda wi: np.abs(wi), "directions"),
    "glossy": ("glossy", "bounce.wi", lambda wi: np.abs(wi), "directions-beside"),
    "neighbours": (
        "room",
        "light.u",
        lambda u: np.where(np.arange(u.shape[1]) % 2, 1 - np.roll(u, 1, axis=1), u),
        "numbers-independent",
    ),
    "spread": (
        "room",
        "path.radiance",
        lambda L: L * np.float32(2) * (np.arange(L.shape[1]) % 2),
        "variance",
    ),
    "survivors": ("rooms", "roulette.survived", lambda survived: ~survived, "roulette-share"),
    "mean": ("room", "light.contribution", lambda c: c * np.float32(1.5), "mean"),
}


@pytest.mark.slow
@pytest.mark.statistical
@pytest.mark.parametrize("case", MANY)
def test_each_statistical_law_has_a_broken_twin(case):
    name, place, change, rule = MANY[case]
    whole = traced(name, seed=suite_seed(), spp=8)
    assert not examine(whole).findings
    assert rule in fired(examine(changed(whole, place, change)))


@pytest.mark.slow
@pytest.mark.statistical
@pytest.mark.parametrize("bug", MANY_PATHS)
def test_a_bug_that_only_many_paths_show_is_named_first(bug):
    diagnosis = examine(zoo_trace(bug, width=32, height=32, spp=8, seed=suite_seed()))
    assert diagnosis.bugs == (bug,)


@pytest.mark.statistical
def test_the_lattice_sampler_breaks_no_law():
    assert not examine(traced("room", sampler="lattice", spp=16, seed=suite_seed())).findings


@pytest.mark.statistical
@pytest.mark.slow
def test_the_chances_that_statistical_laws_give_are_such():
    chances = []
    for seed in range(8):
        evidence = Evidence(traced("room", seed=suite_seed() + seed))
        for rule in statistics.RULES:
            chances += [cell.p for cell in rule.judge(evidence)]
    low = np.mean(np.array(chances) < 0.01)
    assert len(chances) > 300 and low < 0.03
    assert np.mean(np.array(chances) < 0.5) < 0.6


def test_every_statistical_law_has_a_twin():
    by_bugs = {"lamp-points"}  # D15, D17, D18
    assert {rule.id for rule in statistics.RULES} == {rule for *_, rule in MANY.values()} | by_bugs


@pytest.mark.slow
def test_the_table_and_the_alarms_are_written_and_gone_on_with(tmp_path, monkeypatch):
    monkeypatch.setattr(doctor_paper, "KEPT", tmp_path)
    monkeypatch.setattr(doctor_paper, "commit", lambda: "abc1234")
    paper = tmp_path / "DOCTOR.md"
    row = doctor_table.measured(zoo.ZOO["D10"], side=16, spp=4)
    assert (row["rank"], row["rule"], row["named"]) == (1, "light-term", ["D10"])
    doctor_paper.keep("table", row)
    assert doctor_paper.kept("table") == {"D10": row}
    doctor_paper.write("table", doctor_table.text({"D10": row, "P07": None}), paper)
    tasks = list(false_alarms.plan(["cornell_unit"], 20_000, rounds=1))
    assert [only is None for *_, only in tasks] == [True] * 6 + [False] * 6
    alarms = []
    for key, scene, settings, only in (tasks[0], tasks[6]):
        alarms.append(false_alarms.measured(key, scene, replace(settings, width=8, height=8, spp=4), only))
    assert [(alarm["single"], alarm["many"], alarm["paths"]) for alarm in alarms] == [
        ([], [], 256), ([], None, 256)
    ]  # fmt: skip
    doctor_paper.write("alarms", false_alarms.text(alarms), paper)
    text = paper.read_text(encoding="utf-8")
    assert "| D10 |" in text and "| light-term |" in text and "100%" in text and "only time is lost" in text
    assert "| cornell_unit | 1 | 512 |" in text
    doctor_paper.write("table", "new\n", paper)
    text = paper.read_text(encoding="utf-8")
    assert "| D10 |" not in text and "| cornell_unit |" in text


@pytest.mark.parametrize("scene", ["cornell", "coloured_glass", "sky"])
def test_events_without_a_vertex_are_not_judged_by_that_of_another_path(scene):
    trace = gather(tracer.load(scene), tracer.Settings(width=16, height=16, spp=8, max_depth=6))
    hits = trace.tables["hit"]
    kept = np.flatnonzero((hits.path < 1000) | (hits.path >= 1040))
    bare = replace(trace, tables=trace.tables | {"hit": hits.take(kept)})
    found, evidence = examine(bare), Evidence(bare)
    assert {finding.rule for finding in found.findings} <= {"ledger"}  # what their hits brought is not there
    for kind, rule in (("light", "light-f"), ("bounce", "bounce-f")):
        path = bare.tables[kind].path
        lost = (path >= 1000) & (path < 1040)
        (whole,), (verdict,) = (
            [v for v in d.rules if v.rule.id == rule] for d in (examine(trace, {rule}), found)
        )
        assert verdict.checked < whole.checked and verdict.abstained > whole.abstained
        assert np.isnan(evidence.at_vertex(kind, "n")[:, lost]).all()
        assert (evidence.at_vertex(kind, "primitive")[lost] == -1).all()
        assert (evidence.materials(kind)[lost] == -1).all()
        assert np.isfinite(evidence.at_vertex(kind, "n")[:, ~lost]).all()


def test_what_rough_glass_lets_through_by_a_hair_comes_from_no_wrong_side():
    """In float32 f is 6e-8 there, worked out anew in float64 it is 0."""
    settings = tracer.Settings(width=32, height=32, spp=16, seed=40049, precision=32)
    trace = gather(tracer.load("materials"), settings).span(19 * 32 * 16, 20 * 32 * 16)
    light = trace.tables["light"]
    assert ((light["f"] > 0.0) & (light["f"] < 1e-7)).any()
    assert examine(trace, only={"light-nothing"}).findings == ()
