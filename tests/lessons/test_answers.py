"""What people type as an answer is understood, or refused in one line."""

import pytest

from lessons.answer import judge
from lessons.course import lesson, lessons
from lessons.run import Run
from tracer.settings import TracerError


@pytest.fixture(scope="module")
def run():
    return Run(lesson(4))


@pytest.mark.parametrize(
    "said", [["{:.3f}"], ["{:.2f} m"], ["{:.2f}", "m"], ["{:.2f}m"], ["+{:.2f}"], ["{:.3e}"]]
)
def test_a_number_may_have_its_unit_and_any_usual_form(run, said):
    right = run.values["radius_deeper"]
    assert judge(run, lesson(4).task("radius"), [text.format(right) for text in said]).right


def test_a_number_may_have_a_decimal_comma_or_be_a_fraction(run):
    right = run.values["radius_deeper"]
    assert judge(run, lesson(4).task("radius"), [f"{right:.2f}".replace(".", ",")]).right
    assert judge(run, lesson(4).task("radius"), [f"{right * 2:.3f}/2"]).right


@pytest.mark.parametrize("said", ["160 96", "(160, 96)", "160,96", "160，96"])
def test_a_pixel_may_be_written_as_one_likes(run, said):
    assert judge(run, lesson(4).task("rim"), said.split(" ")).right
    assert judge(run, lesson(4).task("rim"), [said]).right


def test_a_bug_may_be_written_small(run):
    assert judge(run, lesson(4).task("friend"), ["s02"]).right


@pytest.mark.parametrize(
    ("task", "said", "why"),
    [
        ("radius", "wide", "is not a number in m"),
        ("radius", "3 s", "is not a number in m"),
        ("radius", "3/0", "divides by 0"),
        ("rim", "3", "two whole numbers"),
        ("rim", "3 -4", "two whole numbers"),
        ("rim", "500 3", "is outside the picture of 192 x 192"),
        ("trapped", "x", "is not the number of one, from 0 to"),
        ("trapped", "99", "is not the number of one, from 0 to"),
        ("friend", "Z99", "is not in the zoo"),
    ],
)
def test_what_is_no_answer_is_refused_in_one_line(run, task, said, why):
    with pytest.raises(TracerError, match=why) as error:
        judge(run, lesson(4).task(task), said.split())
    assert "\n" not in str(error.value)


def test_a_name_that_is_not_there_is_told(run):
    with pytest.raises(TracerError, match="there are radius, rim"):
        lesson(4).task("nothing")
    with pytest.raises(TracerError, match="there is no 99"):
        lesson(99)
    for name in ("nothing", "nowhere.pdf", "start.nothing"):
        with pytest.raises(TracerError, match="lesson 4"):
            run.value(name)


def test_lessons_are_in_order():
    assert list(lessons()) == sorted(lessons())


def test_a_claim_that_does_not_hold_is_one_line():
    class Claim:
        @staticmethod
        def experiment(run):
            raise AssertionError("2 is not 3")

    broken = lesson(4).__class__(lesson(4).folder)
    broken.claim = Claim
    with pytest.raises(TracerError, match="lesson 4: its claim does not hold on this machine: 2 is not 3"):
        Run(broken).value("radius")
