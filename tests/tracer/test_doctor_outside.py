"""The doctor and mistakes that are in no catalogue: the law and the vertex, and no wrong name."""

from dataclasses import replace

import doctor_outside
import doctor_paper
import numpy as np
import pytest
from mutants import changed, traced, with_column
from outside import MISTAKES, hall, third_steps, weekend

from tracer.doctor import examine
from tracer.doctor.statistics.cells import FEW
from tracer.events import END_REASONS

pytestmark = pytest.mark.slow

QUICK = ("f-twice", "roulette-early", "depths-share")
SLOW = (
    "cosine-of-the-lamp", "towards-the-ray", "barrel", "lamp-from-behind", "c++ first-material",
    "c++ product-of-numbers", "balls still-matt", "balls frame-made-once",
)  # fmt: skip


@pytest.mark.parametrize("id", [*QUICK, *(pytest.param(id, marks=pytest.mark.slow) for id in SLOW)])
def test_a_mistake_of_no_catalogue_breaks_its_law_and_gets_no_wrong_name(id):
    mistake = MISTAKES[id]
    causes = mistake.diagnosed().causes
    assert causes[0].rule in mistake.laws and causes[0].count > 0
    assert {f.bug for f in causes if f.bug} <= set(mistake.fair)


def test_a_right_program_that_logs_roulette_only_where_it_is_played_has_no_finding():
    assert MISTAKES["balls right"].diagnosed().findings == ()


FOURTH_RIGHT = (
    "two-rays right-late", "corridor right", "corridor right-doubles", "corridor right-little",
    "corridor right-direct-0", "shed right-32", "shed right-late", "shed right-before",
    "shed right-nothing-0",
)  # fmt: skip
FOURTH = (
    "two-rays not-averaged", "two-rays nudge-inwards", "corridor shadow-hit-stays",
    "corridor half-and-jitter",
    "corridor mean-of-the-two", "shed density-of-the-first", "shed axes-exchanged",
)  # fmt: skip


@pytest.mark.parametrize("id", FOURTH_RIGHT)
def test_right_programs_have_no_finding_however_they_play_roulette_and_whatever_they_log(id):
    assert MISTAKES[id].diagnosed().findings == ()


@pytest.mark.parametrize("id", FOURTH)
def test_a_mistake_that_the_laws_had_never_seen_breaks_a_law_foretold_and_gets_no_wrong_name(id):
    mistake = MISTAKES[id]
    causes = mistake.diagnosed().causes
    assert causes[0].rule in mistake.laws
    assert {f.bug for f in causes if f.bug} <= set(mistake.fair)


THIRD = {mistake.id: mistake for mistake in (*weekend.MISTAKES, *hall.MISTAKES, *third_steps.MISTAKES)}


@pytest.mark.parametrize("id", ["weekend right", "hall right-by-mean", "hall right-evenly"])
def test_a_right_program_may_choose_lamps_in_its_own_way_and_log_what_it_does_not_use(id):
    assert THIRD[id].diagnosed().findings == ()


@pytest.mark.parametrize(
    "id",
    [
        "weekend child-twice", "weekend shadow-from-zero", "weekend camera-not-unit",
        "weekend sum-by-roulette", "hall next-lamp", "hall bulbs-inside-out", "hall choice-again",
        "hall weight-without-choice", "hall weight-not-used", "weekend width-less-one",
        "hall panels-both-sides",
    ],
)  # fmt: skip
def test_a_mistake_of_which_little_is_logged_breaks_its_law_and_gets_no_wrong_name(id):
    causes = THIRD[id].diagnosed().causes
    assert causes[0].rule in THIRD[id].laws
    assert {f.bug for f in causes if f.bug} <= set(THIRD[id].fair)


def test_numbers_of_a_surface_that_was_not_met_are_no_cause_of_their_own():
    assert [f.rule for f in THIRD["weekend camera-not-unit"].diagnosed().causes] == ["unit-direction"]


@pytest.mark.parametrize("id", [mistake.id for mistake in third_steps.MISTAKES])
def test_what_resembles_a_mistake_of_the_catalogue_gets_no_wrong_name(id):
    causes = THIRD[id].diagnosed().causes
    assert causes[0].rule in THIRD[id].laws
    assert {f.bug for f in causes if f.bug} <= set(THIRD[id].fair)


def test_the_same_formula_at_some_vertices_only_has_no_name():
    right = traced("room")
    table = right.tables["light"]
    without_cosine = table["contribution"] / np.maximum(table["cos"], np.float32(1e-30))
    some = np.arange(table.path.size) % 2 == 0
    named = []
    for which in (np.ones_like(some), some):
        wrong = with_column(
            right, "light.contribution", np.where(which, without_cosine, table["contribution"])
        )
        (finding,) = examine(wrong, only={"light-term"}).findings
        assert finding.explanation.startswith("recorded = right / cos")
        named.append(finding.bug)
    assert named == ["D10", None]


def test_a_weight_that_is_almost_1_is_told_where_it_counts_twice():
    assert MISTAKES["weight-twice"].diagnosed().causes[0].explanation == "recorded = right x w"


@pytest.mark.parametrize(
    ("reason", "words"),
    [
        ("roulette", "paths end by roulette, though none was lost just before"),
        ("max_depth", "paths end as the deepest that may be, though they are not so deep"),
        ("escaped", "paths end as escaped, though something is met"),
        ("black", "paths end as at a black surface, though it reflects light"),
    ],
)
def test_an_end_for_a_reason_that_is_not_there_is_told_in_words(reason, words):
    trace = changed(traced("rooms"), "end.reason", lambda was: np.full_like(was, END_REASONS.index(reason)))
    finding = examine(trace, only={"end"}).findings[0]
    assert (finding.explanation, finding.recorded, finding.right) == (words, None, None)


def test_wrong_weights_are_named_where_they_are_another_function_of_the_densities_only():
    right = traced("room", width=32, height=32)
    table = right.tables["light"]
    pdf, other = (
        np.where(table[name] > 0.0, table[name], 1e-6).astype(float) for name in ("pdf", "pdf_bsdf")
    )
    some = np.arange(pdf.size) % 4 == 0
    noise = np.random.default_rng(1).random(pdf.size)
    named = {}
    for words, w in (
        ("another power", 1.0 / (1.0 + (other / pdf) ** 0.25)),
        ("some", np.where(some, 0.5 * table["w"], table["w"])),
        ("neither density", noise),
    ):
        (finding,) = examine(with_column(right, "light.w", w), only={"light-weight"}).findings
        named[words] = finding.bug
    assert named == {"another power": "M01", "some": None, "neither density": None}


@pytest.mark.parametrize("finite", [True, False])
def test_paths_may_be_dropped_as_invalid_only_for_a_number_that_is_none(finite):
    invalid = END_REASONS.index("invalid")
    trace = changed(traced("rooms"), "end.reason", lambda reason: np.full_like(reason, invalid))
    if not finite:
        trace = changed(trace, "hit.contribution", lambda L: L * L.dtype.type(np.nan))
    findings = examine(trace, only={"end"}).findings
    assert [f.explanation.startswith("paths are dropped as invalid") for f in findings] == [True] * finite


@pytest.mark.parametrize(
    ("factor", "words"),
    [
        (lambda t: np.float32(1.37), "recorded = 1.37 x right"),
        (
            lambda t: t.tables["light"]["cos"] ** 2 / t.tables["light"]["distance"],
            "recorded = right x cos^2 / r",
        ),
        (lambda t: np.random.default_rng(1).random(t.tables["light"].path.size, np.float32), ""),
    ],
)
def test_what_is_too_much_is_told_in_the_events_own_numbers(factor, words):
    right = traced("room")
    term = right.tables["light"]["contribution"] * factor(right)
    (finding,) = [f for f in examine(with_column(right, "light.contribution", term)).findings if f.p is None][
        :1
    ]
    assert (finding.rule, finding.bug, finding.explanation) == ("light-term", None, words)


@pytest.mark.statistical
def test_a_single_odd_event_explains_no_distribution():
    crowded = changed(traced("room", spp=8), "bounce.wi", np.abs)
    odd = np.arange(crowded.tables["hit"].path.size) == 100
    both = examine(changed(crowded, "hit.n", lambda n: n * np.float32(0.9), odd))
    follows = {f.rule: f.follows for f in both.findings}
    assert "unit-normal" in follows and follows["directions"] != "unit-normal"


def test_paths_that_were_chosen_by_what_they_did_show_no_distribution():
    right = traced("room")
    few = int(FEW * np.sqrt(right.size))
    tested = {left: examine(replace(right, left_out=left)).rules for left in (few, few + 1)}
    many = {left: {v.state for v in rules if v.rule.id == "directions"} for left, rules in tested.items()}
    assert many == {few: {"clean"}, few + 1: {"not_testable"}}


def test_the_table_of_such_mistakes_is_written(tmp_path):
    paper = tmp_path / "DOCTOR.md"
    row = doctor_outside.measured(MISTAKES["f-twice"])
    doctor_paper.write("outside", doctor_outside.text({"f-twice": row}), paper)
    text = paper.read_text(encoding="utf-8")
    assert "<!-- fourth -->" not in text
    assert "| f-twice |" in text and "| recorded = right x pi x f |" in text and "0 a wrong one" in text
