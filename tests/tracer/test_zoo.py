"""Every bug of the zoo, planted, does to the picture what its symptom says, and is told in full.

A bug is looked at (tests/zoo_looks.py) beside the right tracer with the same random numbers. All looks
together raise a false alarm with a significance of 1 % (Sidak).
"""

import re
import time
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from cases import loaded, slow_but
from catalogue import ABANDONED, CATALOGUE, OURS
from checks import region, samples
from stats import z_limit
from zoo_looks import LOOKS, OTHER

import tracer
from lessons import zoo
from lessons.zoo.pictures import suited
from tracer import Settings, TracerError

BANDS = 16  # into which a look is cut where it is not known which way a bug changes it
LEAST = 50  # bugs of the catalogue
every_bug = pytest.mark.parametrize("bug", zoo.ZOO.values(), ids=zoo.ZOO)
QUICK = ("D01", "D06", "N04", "W01", "S06")
every_look = pytest.mark.parametrize("bug_id", slow_but(LOOKS, *QUICK))
LIMIT = z_limit(sum(BANDS if sign == OTHER else 1 for _, sign in LOOKS.values()))


@cache
def right(bug_id, seed):
    return LOOKS[bug_id][0](zoo.ZOO[bug_id], zoo.RIGHT, seed)


def standard_errors(wrong, right, sign):
    """How many standard errors two looks lie apart the way they should; in the worst band where any way will
    do."""
    apart = wrong - right if wrong.shape == right.shape else np.zeros(1)
    parts = np.array_split(apart, BANDS) if sign == OTHER else [apart * sign]
    found = [part.mean() / (part.std() / np.sqrt(part.size)) for part in parts if part.any()]
    return max(np.abs(found) if sign == OTHER else found, default=0.0)


@pytest.mark.statistical
@every_look
def test_a_bug_is_seen_as_its_symptom_says(suite_seed, bug_id):
    bug, (look, sign) = zoo.ZOO[bug_id], LOOKS[bug_id]
    found = standard_errors(look(bug, bug.steps, suite_seed), right(bug_id, suite_seed), sign)
    print(f"{bug_id}: {found:.1f} standard errors, {LIMIT:.1f} are needed")
    assert found > LIMIT, f"{bug_id}, {bug.title}: {found} standard errors"


OTHERS = ("E01", "D01", "D15", "B01", "N04", "S06", "R06", "F05", "P03")


@pytest.mark.statistical
@pytest.mark.parametrize("bug_id", slow_but(OTHERS, "D01", "N04", "S06"))
def test_the_right_tracer_with_other_numbers_is_not_taken_for_a_bug(suite_seed, bug_id):
    """The broken twin: what is seen above is the bug, not the noise."""
    look, sign = LOOKS[bug_id]
    other = look(zoo.ZOO[bug_id], zoo.RIGHT, suite_seed + 1)
    assert standard_errors(other, right(bug_id, suite_seed), sign) < LIMIT


def test_every_bug_is_looked_at_but_those_that_only_take_time():
    assert set(zoo.ZOO) - set(LOOKS) == {bug.id for bug in zoo.ZOO.values() if bug.only_cost}


@pytest.mark.parametrize("bug", [b for b in zoo.ZOO.values() if b.only_cost], ids=lambda b: b.id)
def test_a_bug_that_only_takes_time_leaves_the_picture_as_it_is(suite_seed, bug):
    settings = bug.asked(width=6, height=6, spp=1, seed=suite_seed)
    pictures = [tracer.render(loaded(bug.scene), settings, steps=s) for s in (bug.steps, zoo.RIGHT)]
    assert pictures[0].rgb.tobytes() == pictures[1].rgb.tobytes()


@pytest.mark.timed
def test_an_engine_for_every_number_takes_many_times_as_long(suite_seed):
    settings = Settings(width=12, height=12, spp=2, seed=suite_seed, integrator="direct")
    took = []
    for steps in (zoo.RIGHT, zoo.RIGHT, zoo.steps("P01")):
        began = time.perf_counter()
        tracer.render(loaded("cornell"), settings, steps=steps)
        took.append(time.perf_counter() - began)
    assert took[2] > 2.0 * took[1]


def test_the_zoo_has_the_catalogues_bugs_by_their_ids():
    assert set(zoo.ZOO) <= set(CATALOGUE) | set(OURS)
    assert len(set(zoo.ZOO) & set(CATALOGUE)) >= LEAST
    assert len(zoo.ZOO) == sum(map(len, zoo.FAMILIES.values()))


def test_all_normals_all_directions_and_all_of_the_abandoned_castray_are_there():
    assert {f"{letter}0{k}" for letter in "NW" for k in range(1, 5)} <= set(zoo.ZOO)
    assert set(ABANDONED) | {"castray"} <= set(zoo.ZOO)


@every_bug
def test_the_words_of_a_bug_are_sentences_and_short(bug):
    assert re.fullmatch(r"\S.*[^.]", bug.title) and len(bug.title) <= 60
    assert re.fullmatch(r"[A-Z].*\.|wi.*\.", bug.symptom) and len(bug.symptom) <= 120
    assert bug.wrong.strip() and len(bug.wrong) <= 220
    assert re.match(r"I(1?\d): \S", bug.law)
    assert not bug.note or re.fullmatch(r"[A-Z].*\.", bug.note)
    for text in (bug.title, bug.symptom, bug.wrong, bug.law, bug.note):
        assert text.isascii() and "\n" not in text
    assert all(wrong.__doc__.splitlines()[0].endswith((".", ":")) for wrong in bug.changes.values())


@every_bug
def test_the_command_of_a_bug_asks_for_its_settings(bug):
    from viewer.cli import command_line
    from viewer.words import Speaker

    _, bound, _ = command_line(Speaker()).parse_args(
        bug.command.removeprefix("castray ").split(), exit_on_error=False
    )
    from viewer.options import settings_and_steps

    settings, steps = settings_and_steps(bound.arguments["options"])
    assert settings == bug.asked(bug=bug.id) and steps == bug.steps
    assert bound.arguments["scene"] == bug.scene


def test_several_bugs_at_once_each_do_what_they_do_alone(suite_seed):
    settings = Settings(width=8, height=8, spp=2, seed=suite_seed, integrator="direct", jitter=False)
    alone = {bug: zoo.steps(bug) for bug in ("E01", "D01", "D06")}
    together = zoo.planted(replace(settings, bug="E01, D01,D06"))
    for steps in alone.values():
        changed = [step for step in vars(steps) if getattr(steps, step) is not getattr(zoo.RIGHT, step)]
        assert changed and all(getattr(together, step) is getattr(steps, step) for step in changed)
    light = {bug: picture_of(settings, steps) for bug, steps in alone.items()}
    light |= {"": picture_of(settings, zoo.RIGHT), "D01,E01": picture_of(settings, zoo.steps("D01,E01"))}
    salt = light["E01"] - light[""]  # it is added to whatever light samples bring
    assert salt.max() > 0.0 and np.allclose(light["D01,E01"] - light["D01"], salt, atol=1e-4)


def picture_of(settings, steps):
    return tracer.render(loaded("cornell"), settings, steps=steps).rgb


@pytest.mark.parametrize(
    ("bugs", "said"),
    [
        ("D01,D02", "D01 and D02 both replace the step visibility"),
        ("D08,castray", "D08 and castray both replace the step light_point"),
        ("E01,Z09", "'Z09' is not in the zoo"),
        ("E01,", "'' is not in the zoo"),
        ("E01,P02", "P02 lets no path end"),
    ],
)
def test_bugs_that_cannot_be_planted_at_once_are_refused_in_one_line(bugs, said):
    with pytest.raises(TracerError, match=said) as refused:
        zoo.planted(Settings(bug=bugs))
    assert "\n" not in str(refused.value)


def test_look_alikes_are_bugs_of_the_zoo_each_in_one_class():
    members = [bug_id for group in zoo.ALIKE for bug_id in group]
    assert set(members) <= set(zoo.ZOO) and len(members) == len(set(members))
    assert zoo.alike("E04") == {"E01", "E04"} and zoo.alike("D06") == {"D06"}


@pytest.mark.parametrize("group", zoo.ALIKE, ids=sorted)
def test_look_alikes_give_the_same_picture_bit_for_bit(suite_seed, group):
    bugs = [zoo.ZOO[bug_id] for bug_id in sorted(group)]
    settings = bugs[0].asked(width=8, height=8, spp=1, seed=suite_seed)
    found = {tracer.render(loaded(b.scene), settings, steps=b.steps).rgb.tobytes() for b in bugs}
    assert len(found) == 1


def test_a_bug_that_lets_no_path_end_is_refused_without_a_depth():
    with pytest.raises(TracerError, match="P02 lets no path end; give it a max_depth") as refused:
        zoo.planted(Settings(bug="P02"))
    assert "\n" not in str(refused.value)
    assert zoo.planted(Settings(bug="P02", max_depth=8)) == zoo.steps("P02")


# Luminance over the right one, from the homework's own framework with the three mistakes in it.
ABANDONED_RATIOS = {"left wall": 2.26, "right wall": 1.84, "back wall": 1.53}


@pytest.mark.slow
@pytest.mark.statistical
@pytest.mark.parametrize("name", ABANDONED_RATIOS)
def test_the_abandoned_castray_is_as_bright_as_it_was(suite_seed, name):
    """Within 6 % and four standard errors of what its own framework gave."""
    bug, pixels = zoo.ZOO["castray"], region(name, 196, 196)[::4]
    settings = bug.asked(width=196, height=196, spp=64, seed=suite_seed)
    wrong, correct = (
        np.tensordot([0.2126, 0.7152, 0.0722], samples(loaded("cornell"), settings, steps, pixels), 1)
        for steps in (bug.steps, zoo.RIGHT)
    )
    ratio, error = wrong.mean() / correct.mean(), wrong.std() / np.sqrt(wrong.size) / correct.mean()
    print(f"{name}: {ratio:.3f} +- {error:.3f}")
    assert abs(ratio - ABANDONED_RATIOS[name]) < 0.06 * ABANDONED_RATIOS[name] + 4.0 * error


@pytest.mark.parametrize("name", ["coloured_glass", "pool", "sky", "white_furnace"])
def test_every_mistake_can_be_planted_where_lights_are_no_shapes(name):
    scene = tracer.load(name)
    for bug in suited(scene, zoo.ZOO.values()):
        picture = tracer.render(scene, bug.asked(width=4, height=4, spp=1), steps=bug.steps)
        assert picture.rgb.shape == (4, 4, 3), bug.id
