"""Two traces of the same random numbers in step."""

from dataclasses import replace
from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from cases import loaded, slow_but

import tracer
from lessons import zoo
from tracer.trace import gather
from tracer.twin import compare
from tracer.twin.exact import exact_sums

SMALL = {"width": 7, "height": 6, "spp": 4}
ALL = 10**6


@cache
def pair(bug_id, scene=None):
    """The right trace and that of a bug, where the bug shows."""
    bug = zoo.of(bug_id)
    scene = loaded(scene or bug.scene)
    settings = bug.asked(**SMALL)
    return gather(scene, settings), gather(scene, settings, bug.steps)


def altered(trace, kind, name, change):
    """The trace with another column."""
    table = trace.tables[kind]
    columns = table.columns | {name: change(table[name].copy())}
    return replace(trace, tables=trace.tables | {kind: replace(table, columns=columns)})


def of_path(trace, row):
    """[(kind, depth, {carried field: its bits})] of one path, in its order."""
    events = []
    for kind, table in trace.tables.items():
        for k in np.flatnonzero(table.path == row):
            values = {name: column[..., k].tobytes() for name, column in table.columns.items()}
            events.append((table.step[k], kind, table.depth[k], values))
    return [event[1:] for event in sorted(events, key=lambda event: event[0])]


def test_what_costs_time_only_changes_no_event():
    found = compare(*pair("P01"))
    assert found.same and not found.causes and not found.largest and found.rounded == 0
    assert found.pairs == 7 * 6 * 4 and found.told.shares == ()


PARTING = [
    ("E01", "hit", "w"),
    ("D01", "light", "visible"),
    ("D06", "light", "f"),
    ("D10", "light", "contribution"),
    ("D17", "light", "q"),
    ("B03", "light", "f"),
    ("B12", "bounce", "beta"),
    ("N02", "hit", "ng"),
    ("R01", "roulette", "beta"),
    ("F01", "end", "radiance"),
    ("F05", "camera", "film"),
    ("castray", "light", "q"),
]


@pytest.mark.parametrize(("bug_id", "kind", "what"), slow_but(PARTING, *PARTING[::3]))
def test_paths_part_in_the_number_that_the_mistake_makes(bug_id, kind, what):
    found = compare(*pair(bug_id))
    assert not found.same
    first = found.causes[0]
    assert (first.kinds, first.what) == ((kind, kind), what)
    assert first.example.numbers[0].field.name == what
    assert sum(cause.pairs for cause in found.causes) == found.differing


@pytest.mark.parametrize("bug_id", ["D01", "R01", "B10"])
def test_the_first_event_that_differs_is_that_of_a_plain_look(bug_id):
    a, b = pair(bug_id)
    found = {(p.x, p.y, p.sample): p for p in compare(a, b, most=ALL, exact=True).largest}
    for row in range(0, a.size, 3):
        one, other = of_path(a, row), of_path(b, row)
        place = 0
        while place < min(len(one), len(other)) and one[place] == other[place]:
            place += 1
        parting = found.get(tuple(int(a.paths[name][row]) for name in ("x", "y", "sample")))
        if place == len(one) == len(other):
            assert parting is None
            continue
        assert parting.kinds == (one[place][0], other[place][0])
        assert parting.steps == (place, place)
        if parting.numbers:
            apart = {n for n, v in one[place][2].items() if v != other[place][2][n]}
            assert apart == {number.field.name for number in parting.numbers}


@pytest.mark.parametrize("bug_id", ["E01", "D10", "F01", "B15", "R01", "castray"])
def test_shares_add_up_to_the_whole_difference_without_rounding(bug_id):
    a, b = pair(bug_id)
    told = compare(a, b).told
    assert told.left_out == 0
    for channel in range(3):
        sums = [
            sum(map(Fraction, trace.paths["radiance"][channel].astype(float).tolist())) for trace in (a, b)
        ]
        whole = (sums[1] - sums[0]) / a.size
        assert sum(share.difference[channel] for share in told.shares) == whole != 0
        assert told.difference[channel] == whole
        assert [mean[channel] for mean in told.means] == [value / a.size for value in sums]
        for share in told.shares:
            assert share.means[1][channel] - share.means[0][channel] == share.difference[channel]


def test_a_share_is_told_by_technique_and_depth():
    told = compare(*pair("E01")).told
    found = {(share.technique, share.depth) for share in told.shares if share.technique != "rounding"}
    assert found and all(technique == "emission" and depth > 0 for technique, depth in found)
    film = compare(*pair("F01")).told
    assert {share.technique for share in film.shares} - {"rounding"} == {"film"}


def test_a_path_with_a_term_that_is_not_finite_is_told_apart():
    a, _ = pair("E01")
    lit = int(np.flatnonzero(a.tables["light"]["contribution"].any(axis=0))[0])
    path = a.tables["light"].path[lit]
    b = altered(a, "light", "contribution", lambda c: np.where(np.arange(c.shape[1]) == lit, np.nan, c))
    radiance = a.paths["radiance"].copy()
    radiance[:, path] = 0.0
    b = replace(b, paths=a.paths | {"radiance": radiance})
    told = compare(a, b).told
    (share,) = told.shares
    assert (share.technique, share.depth) == ("not finite", None)
    assert [float(v) * a.size for v in share.difference] == (-a.paths["radiance"][:, path]).tolist()
    radiance[:, path] = np.inf
    assert compare(a, b).told.left_out == 1


def test_paths_without_a_twin_are_counted_and_the_others_compared():
    a, b = pair("D10")
    odd = np.arange(b.size) % 3 > 0
    found = compare(a, b.take(odd), most=ALL)
    assert found.pairs == odd.sum() and found.alone == (a.size - odd.sum(), 0)
    assert not compare(a, a.take(odd)).same
    whole = {(p.x, p.y, p.sample): p for p in compare(a, b, most=ALL).largest}
    for parting in found.largest:
        assert whole[parting.x, parting.y, parting.sample].steps == parting.steps
    with pytest.raises(tracer.TracerError, match="in common"):
        compare(a.take(odd), b.take(~odd))


def test_a_path_that_ends_earlier_parts_where_it_ends():
    a, _ = pair("D10")
    last = a.tables["end"]
    shorter = replace(a, tables=a.tables | {"end": last.take(last.path != 5)})
    (parting,) = compare(a, shorter).largest
    assert parting.kinds == ("end", None) and parting.what == "event" and parting.steps[1] is None
    assert (parting.x, parting.y, parting.sample) == (1, 0, 1)


def test_not_a_number_equals_not_a_number():
    a, _ = pair("D10")

    def lost(column):
        column[..., 3] = np.nan
        return column

    one = altered(a, "bounce", "pdf", lost)
    assert compare(one, one).same
    (cause,) = compare(a, one).causes
    assert (cause.kinds[0], cause.what, cause.pairs) == ("bounce", "pdf", 1)
    far = altered(a, "bounce", "pdf", lambda c: np.where(np.arange(c.size) == 3, np.inf, c))
    assert not compare(a, far).same


def test_roundings_of_one_number_are_the_same_unless_every_bit_counts():
    a, _ = pair("D10")
    b = altered(a, "bounce", "f", lambda f: np.nextafter(f, np.float32(9.0)))
    found = compare(a, b)
    assert found.same and found.rounded > 0
    assert not compare(a, b, exact=True).same
    assert not compare(a, altered(a, "bounce", "f", lambda f: f * np.float32(1.0001))).same


@pytest.mark.parametrize(
    ("other", "said"),
    [
        ({"seed": 9}, "seed is 0 in a and 9 in b"),
        ({"sampler": "lattice"}, "sampler is independent in a"),
        ({"width": 5}, "width is 7 in a and 5 in b"),
    ],
)
def test_other_random_numbers_are_refused(other, said):
    scene, settings = loaded("cornell_unit"), tracer.Settings(**SMALL)
    one, two = (gather(scene, s, pixels=[1]) for s in (settings, replace(settings, **other)))
    with pytest.raises(tracer.TracerError, match=said):
        compare(one, two, ("a", "b"))


def test_settings_that_differ_are_said_and_paths_part_where_they_matter():
    scene, settings = loaded("cornell_unit"), tracer.Settings(**SMALL)
    one, two = (gather(scene, s) for s in (settings, replace(settings, strategy="light")))
    found = compare(one, two)
    assert found.notes == ("Settings differ: strategy mis and light.",)
    assert {cause.what for cause in found.causes} == {"w"}


def test_a_field_that_only_one_has_is_not_compared_and_said():
    a, b = pair("D01")
    columns = {name: column for name, column in b.tables["light"].columns.items() if name != "visible"}
    less = replace(b, tables=b.tables | {"light": replace(b.tables["light"], columns=columns)})
    found = compare(a, less)
    assert found.uncompared == (("light.visible", 0),)
    assert found.causes[0].what == "contribution"


def test_exact_sums_are_those_of_fractions(suite_seed):
    rng = np.random.default_rng(suite_seed)
    values = rng.normal(size=3000) * 2.0 ** rng.integers(-1070, 900, 3000)
    values[:9] = (0.0, -0.0, 5e-324, -5e-324, 1e308, -1e308, 2.0**-1022, 1.0, 1.0 + 2.0**-52)
    cell = rng.integers(0, 4, values.size)
    wanted = [sum(map(Fraction, values[cell == k].tolist())) for k in range(4)]
    assert exact_sums(cell, values, 4) == wanted


def test_paths_that_gather_nothing_are_compared_too():
    settings = tracer.Settings(width=8, height=8, spp=1)
    corner = gather(loaded("cornell_unit"), settings, pixels=np.array([0]))  # beside the room
    assert not corner.paths["radiance"].any()
    found = compare(corner, corner)
    assert found.same and found.told.shares == ()
