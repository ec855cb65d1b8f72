"""The mistakes of the bug zoo are caught by the suite's checks, and the right tracer passes them all.

Each check allows 4 standard errors, or a significance of 1 %; a mistake is planted by replacing a step, and
the loops themselves stay as they are. Some mistakes show only with things that the scenes of these checks
have not; tests/tracer/test_zoo.py looks at them, and at all others, in scenes of their own.
"""

import pickle

import checks
import pytest
from zoo_looks import LOOKS

from lessons import zoo
from tracer import TracerError, built_in_scenes
from tracer.integrator import ALL as LOOPS

# What the checks' scenes have not: several lamps and spheres that shine, rough and varnished surfaces, clear
# glass, smooth normals, spheres that scatter; pictures that are not square, and edges. P02 never ends.
ELSEWHERE = {
    *(
        "D14",
        "D18",
        "B15",
        "W03",
        "N03",
        "N04",
        "G09",
        "B14",
        "S07",
        "S08",
        "S09",
        "S02",
        "S04",
        "S06",
        "G08",
    ),
    *("F05", "F06", "P02"),
}
TO_CATCH = {k: bug for k, bug in zoo.ZOO.items() if k not in ELSEWHERE and not bug.only_cost}
every_bug = pytest.mark.parametrize("bug", zoo.ZOO.values(), ids=zoo.ZOO)


@pytest.mark.statistical
@pytest.mark.parametrize("check", checks.CHECKS, ids=lambda check: check.__name__)
def test_the_right_tracer_passes(suite_seed, check):
    assert check(suite_seed) <= 1.0


@pytest.mark.slow
@pytest.mark.statistical
@pytest.mark.parametrize("bug", TO_CATCH.values(), ids=TO_CATCH)
def test_a_planted_bug_is_caught(suite_seed, bug):
    seen = {}
    for check in checks.CHECKS:
        seen[check.__name__] = check(suite_seed, bug.steps)
        if seen[check.__name__] > 1.0:
            print(f"{bug.id} {bug.title}: {check.__name__} is off {seen[check.__name__]:.2g} times too far")
            return
    pytest.fail(f"{bug.id} {bug.title} passes every check: {seen}")


def test_most_bugs_are_caught_here_and_all_others_are_looked_at():
    assert ELSEWHERE <= set(LOOKS)
    assert len(TO_CATCH) > 2 * len(ELSEWHERE)


@every_bug
def test_a_bug_is_told_in_full(bug):
    assert zoo.ZOO[bug.id] is bug
    assert all((bug.title, bug.symptom, bug.wrong, bug.law, bug.changes or bug.only_cost))
    assert bug.scene in built_in_scenes()
    assert bug.integrator in LOOPS
    for step, wrong in bug.changes.items():
        assert getattr(bug.steps, step) is wrong
        assert wrong is not getattr(zoo.RIGHT, step)
        assert wrong.__doc__


@every_bug
def test_a_bug_travels_to_another_process(bug):
    assert pickle.loads(pickle.dumps(bug.steps)) == bug.steps


def test_a_bug_that_is_not_there_is_refused_with_those_that_are():
    with pytest.raises(TracerError, match=r"E99.*E01.*D01.*R01") as refused:
        zoo.steps("E99")
    assert "\n" not in str(refused.value)
