"""One path as it would be: what is supposed comes to pass, all else follows the same laws and adds up."""

import math

import numpy as np
import pytest

import tracer
from lessons.zoo import planted
from tracer.what_if import parse, supposed, written

SETTINGS = tracer.Settings(width=24, height=24, spp=4)
PLACE = 12, 12, 1


@pytest.fixture(scope="module")
def box():
    """The unit box."""
    return tracer.load("cornell_unit")


@pytest.fixture(scope="module")
def as_it_is(box):
    """The path of which something is supposed."""
    return tracer.inspect(box, SETTINGS, *PLACE).paths[0]


def would(scene, *texts, settings=SETTINGS):
    """That path with these suppositions."""
    return supposed(scene, settings, *PLACE, parse(texts), planted(settings)).paths[0]


def events(path, kind, depth):
    """Values of the events of that kind at that depth."""
    return [e.values for e in path.events if e.kind.name == kind and e.depth == depth]


def test_a_bounce_goes_where_it_is_supposed_to_with_the_f_and_density_of_that_direction(box):
    path = would(box, "0.bounce=20,30")
    bounce, hit = events(path, "bounce", 0)[0], events(path, "hit", 0)[0]
    assert np.dot(bounce["wi"], hit["n"]) == pytest.approx(math.cos(math.radians(20)), rel=1e-5)
    assert bounce["pdf"] == pytest.approx(math.cos(math.radians(20)) / math.pi, rel=1e-5)
    assert np.allclose(bounce["beta"], bounce["f"] * bounce["cos"] / bounce["pdf"], rtol=1e-5)


def test_a_direction_below_the_surface_ends_the_path(box):
    assert would(box, "0.bounce=120,0").end == "absorbed"


def test_a_light_sample_uses_the_numbers_that_are_supposed(box):
    light = events(would(box, "0.light=0.5,0.25,0.75"), "light", 0)[0]
    assert light["u"].tolist() == [0.5, 0.25, 0.75]


@pytest.mark.parametrize("fate", ["survive", "stop"])
def test_the_roulette_decides_as_supposed(box, fate):
    path = would(box, f"4.roulette={fate}")
    assert events(path, "roulette", 4)[0]["survived"] == (fate == "survive")
    assert (path.end == "roulette" and path.events[-1].depth == 4) == (fate == "stop")


def test_the_ledger_of_a_supposed_path_adds_up_exactly(box):
    path = would(box, "0.light=0.5,0.25,0.75", "1.bounce=40,-60", "2.light=0.1,0.9,0.1")
    total = np.zeros(3, path.radiance.dtype)
    for event in path.events:
        total = total + event.values.get("contribution", np.zeros(3, path.radiance.dtype))
    assert np.array_equal(total, path.radiance)


def test_supposing_what_is_so_changes_nothing(box, as_it_is):
    u = ",".join(repr(float(v)) for v in events(as_it_is, "light", 0)[0]["u"])
    path = would(box, f"0.light={u}", "4.roulette=stop")
    assert path.as_dict(box)["radiance"] == as_it_is.as_dict(box)["radiance"]
    assert path.end == as_it_is.end and len(path.events) == len(as_it_is.events)


def test_what_comes_before_is_as_it_is(box, as_it_is):
    path = would(box, "2.bounce=10,10")
    before = [e.as_dict(box) for e in as_it_is.events if e.depth < 2]
    assert [e.as_dict(box) for e in path.events if e.depth < 2] == before


def test_a_supposed_path_keeps_the_laws(box):
    """Each number follows from the others as in any path: no law that looks at one event is broken."""
    from tracer.doctor import LAWS, examine
    from tracer.trace import gather
    from tracer.what_if import _Supposing

    settings = tracer.Settings(width=2, height=2, spp=2)
    what = parse(["0.bounce=20,30", "0.light=0.5,0.25,0.75", "4.roulette=survive"])
    trace = gather(box, settings.at_size_of(box), _Supposing(planted(settings), what, settings.dtype).steps)
    single = {rule.id for rule in LAWS}
    fired = [f.rule for f in examine(trace).findings if f.rule in single and not f.rule.startswith("numbers")]
    assert fired == []


def test_with_a_planted_bug_the_bug_stays(box):
    wrong = tracer.Settings(width=24, height=24, spp=4, bug="D10")
    light = events(would(box, "0.light=0.5,0.25,0.75", settings=wrong), "light", 0)[0]
    right = events(would(box, "0.light=0.5,0.25,0.75"), "light", 0)[0]
    assert np.all(light["contribution"] > right["contribution"])


@pytest.mark.parametrize("integrator", ["path", "direct", "walk"])
def test_every_integrator_can_be_supposed_of(box, integrator):
    path = would(box, "0.bounce=45,200", settings=tracer.Settings(width=24, height=24, integrator=integrator))
    assert np.arccos(
        np.dot(events(path, "bounce", 0)[0]["wi"], events(path, "hit", 0)[0]["n"])
    ) == pytest.approx(math.pi / 4, rel=1e-4)


@pytest.mark.parametrize(
    ("text", "part"),
    [("1.jump=3", "1.jump"), ("bounce=1,2", "bounce"), ("1.bounce=1", "2 numbers"),
     ("1.bounce=1,x", "2 numbers"), ("1.bounce=nan,0", "2 numbers"), ("1.bounce=200,0", "180"),
     ("0.light=0,1,0", "1 left out"),
     ("0.light=0,0", "3 numbers"), ("4.roulette=maybe", "survive"), ("99.bounce=1,2", "99.bounce")],
)  # fmt: skip
def test_what_cannot_be_supposed_is_told_in_one_line(box, text, part):
    with pytest.raises(tracer.TracerError) as error:
        would(box, text)
    assert (
        "\n" not in str(error.value) and str(error.value).startswith("what_if: ") and part in str(error.value)
    )


def test_a_mirror_leaves_no_choice():
    scene = tracer.load("mirror_corridor")
    for y in range(24):
        first = tracer.inspect(scene, SETTINGS, 12, y, 0).paths[0]
        if events(first, "bounce", 0) and events(first, "bounce", 0)[0]["delta"]:
            with pytest.raises(tracer.TracerError, match="mirror"):
                supposed(scene, SETTINGS, 12, y, 0, parse(["0.bounce=10,0"]))
            return
    pytest.fail("no mirror seen")


def test_what_is_written_is_read_as_the_same():
    what = parse(["4.roulette=stop", "0.light=0.125,0.5,0.75", "1.bounce=30,-45.5"])
    assert parse(written(what)) == what
