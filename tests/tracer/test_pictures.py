"""The doctor's hypotheses from a picture alone: its mistake among the first, none for a right one.

Seeds are fixed; a right picture may look wrong by chance, which in 60 of them (sizes 16 to 128, 1 to 64
samples per pixel, three integrators) never happened.
"""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import picture_table
import pytest
from cases import loaded, slow_but
from outside import steps as outside

import tracer
from lessons import zoo
from lessons.zoo import ZOO, alike, pictures
from lessons.zoo.pictures import RIGHTS, album, all_at_once, looks, mixtures, stored, straight_and_all, suited
from tracer.doctor.picture import Hypothesis, clues, features, fit, judged, likelier_curve, resampled
from tracer.doctor.picture.clues import to_log
from tracer.doctor.picture.walls import shown
from tracer.picture import to_srgb
from tracer.trace.jsonl.schema import call_fields

pytestmark = pytest.mark.slow

CURVES = ("srgb", 0.6, 1.0)
SCENE = loaded("cornell")


@cache
def picture(*bugs, side=48, spp=8, seed=7):
    """A picture of the homework's scene by a tracer with these bugs."""
    bug = all_at_once([ZOO[name] for name in bugs]) if bugs else RIGHTS[0]
    return tracer.render(SCENE, bug.asked(width=side, height=side, spp=spp, seed=seed), steps=bug.steps).rgb


def screen(rgb, gamma=None):
    """The same in 8 bits, from 0 to 1."""
    if gamma is None:
        return to_srgb(rgb) / 255.0
    return np.round(255.0 * np.clip(rgb, 0.0, 1.0) ** gamma) / 255.0


def opinion(values, curves=CURVES, mixed=lambda ids, spp: None, spp=None):
    return judged(np.asarray(values, float), curves != (None,), curves, SCENE, stored(), mixed, spp)


def named(found):
    """Every id of the first hypothesis, look-alikes too."""
    return {*found.hypotheses[0].bugs, *found.hypotheses[0].alike} if found.hypotheses else set()


BIASED = ("E01", "E02", "D01", "D06", "D10", "B02", "B12", "W01", "N01", "R01", "F03")


@pytest.mark.parametrize("bug", slow_but(BIASED, "E01", "D06", "B12"))
def test_a_mistake_that_shows_is_the_first_hypothesis(bug):
    assert named(opinion(screen(picture(bug)))) & alike(bug)


@pytest.mark.parametrize("bug", slow_but(("E01", "D06", "F01"), "D06"))
def test_so_it_is_from_linear_numbers(bug):
    assert named(opinion(picture(bug), (None,))) & alike(bug)


@pytest.mark.parametrize(("side", "spp"), [(32, 2), (48, 8)])
def test_a_right_picture_gives_no_hypothesis(side, spp):
    for values, curves in (
        (screen(picture(side=side, spp=spp)), CURVES),
        (picture(side=side, spp=spp), (None,)),
    ):
        assert opinion(values, curves).is_right


def test_two_mistakes_at_once_are_told_apart():
    found = opinion(screen(picture("E01", "D06")), ("srgb",), mixtures(SCENE, ZOO))
    assert found.hypotheses[0].bugs == ("E01", "D06")


def test_what_is_not_in_the_catalogue_fits_nothing():
    odd = picture() * np.linspace(0.2, 3.0, 48)[None, :, None]
    found = opinion(screen(odd), ("srgb",))
    assert not found.hypotheses and not found.is_right and found.nearest is not None


def test_a_factor_is_called_a_factor():
    for values, curves in ((3.0 * picture(), (None,)), (screen(0.5 * picture()), ("srgb",))):
        first = opinion(values, curves).hypotheses[0]
        assert first.factor == pytest.approx(3.0 if curves == (None,) else 0.5, rel=0.05)
        assert first.bugs == (("F04",) if curves == (None,) else ())


def test_the_curve_of_the_homework_is_found_and_undone():
    found = opinion(screen(picture(), 0.6))
    assert found.is_right and found.reading.curve == 0.6
    assert found.reading.rgb == pytest.approx(np.clip(picture(), 0.0, 1.0), abs=0.01)
    assert not opinion(screen(picture(), 0.6), ("srgb",)).is_right


def test_a_curve_that_was_said_wrongly_is_told_from_the_likelier_one():
    for values, said, likelier in ((screen(picture()), 0.6, "srgb"), (screen(picture(), 0.6), 0.6, None)):
        assert likelier_curve(values, opinion(values, (said,)), stored()) == likelier


def test_a_picture_without_any_light_is_called_black_and_nothing_else():
    (found,) = opinion(np.zeros((48, 48, 3))).hypotheses
    assert (found.bugs, found.marks) == ((), (("black", 1.0),))


@pytest.mark.parametrize(
    ("turned", "said"),
    [
        (lambda v: v[::-1], "upside down"),
        pytest.param(lambda v: v[:, ::-1], "left and right exchanged", marks=pytest.mark.slow),
        pytest.param(lambda v: v[..., ::-1], "red and blue exchanged", marks=pytest.mark.slow),
    ],
)
def test_a_picture_that_is_the_wrong_way_round_is_said_and_undone(turned, said):
    found = opinion(turned(screen(picture())))
    assert found.is_right and found.reading.turn == said
    assert opinion(screen(picture())).reading.turn is None


def test_a_picture_of_another_shape_is_compared_by_its_middle_or_as_stretched():
    values = screen(picture())
    found = opinion(np.concatenate((values[:, :10], values, values[:, -10:]), axis=1))
    assert found.reading.shape == "middle" and found.is_right
    assert opinion(values.repeat(2, axis=1)).reading.shape == "stretched"


def test_pixels_that_are_no_numbers_and_rows_that_nobody_drew_are_hypotheses():
    holes, band = picture().copy(), picture().copy()
    holes[10, 10], band[38:] = np.nan, 0.0
    assert opinion(holes, (None,)).hypotheses[0].bugs == ("B15",)
    assert opinion(band, (None,)).hypotheses[0].bugs == ("P06",)


def test_walls_say_how_bright_each_object_is():
    found = {wall.name: wall.ratio for wall in opinion(picture("D06"), (None,)).walls}
    assert found["left_wall"][1] > 3.0 and found["back"] == pytest.approx(1.0, abs=0.25)


def test_resampling_keeps_the_mean_whatever_the_size():
    values = np.random.default_rng(1).random((37, 23, 3))
    for size in ((8, 8), (37, 23), (50, 40)):
        assert resampled(values, *size).mean() == pytest.approx(values.mean())
    assert resampled(values, 37, 23) == pytest.approx(values)


def test_the_black_rim_of_the_right_picture_is_no_lost_row():
    """Walls end where no pixel of these sizes does."""
    for side in (33, 64, 100, 200):
        seen = resampled(stored().picture, side, side)
        rim = (shown(SCENE, side, side) >= 0).any(axis=1)
        assert opinion(np.where(rim[:, None, None], seen, 0.0), (None,), spp=256).hypotheses == ()


def test_the_table_holds_what_the_tracers_of_today_draw():
    """The broken twin: another bug's looks are far from it."""
    for bug in ("E01", "D06"):
        seen = features(picture(bug, side=40, spp=16))
        assert fit(seen, stored().bugs[bug]).typical < 1.0 < fit(seen, stored().bugs["B02"]).typical


def test_other_scenes_are_compared_with_what_is_rendered_now():
    unit = loaded("cornell_unit")
    few = [bug for bug in suited(unit, ZOO.values()) if bug.id in ("E02", "B02")]
    known = album(unit, few)
    bug = few[1]
    rgb = tracer.render(unit, bug.asked(width=32, height=32, spp=8, seed=3), steps=bug.steps).rgb
    found = judged(rgb.astype(float), False, (None,), unit, known, lambda ids, spp: None)
    assert found.hypotheses[0].bugs == ("B02",)
    assert looks(unit, replace(bug, settings=bug.settings))[0].at.keys() == {1, 4, 16}


def test_the_table_counts_look_alikes_and_no_part_of_a_mixture():
    first, second = Hypothesis(("E01", "D06"), alike=("E04 + D06",)), Hypothesis(("D10",))
    assert picture_table.rank((first, second), "E01+D06") == picture_table.rank((first,), "E04+D06") == 1
    assert picture_table.rank((first, second), "D10") == 2
    assert picture_table.rank((first, second), "E01") is None
    assert picture_table.rank((Hypothesis(("castray",)),), "E01+D01+D06") == 1


def test_it_is_told_how_many_mixtures_are_rendered(monkeypatch):
    monkeypatch.setattr(pictures, "looks", lambda *_: ("looks", None))
    told = []
    mixed = mixtures(SCENE, ZOO, lambda done, total: told.append((done, total)))
    assert mixed(("E01", "D06"), 16) == "looks"
    assert mixed(("E01", "E02"), 16) is None  # they replace the same step
    for _ in range(11):
        mixed(("E01", "D06"), 64)
    assert told[0] == (1, 10) and told[9:] == [(10, 10), (11, 11), (12, 12)]


def outsiders(settings=RIGHTS[0].settings, scene=SCENE, side=(64, 64), **changes):
    """A picture in 8 bits by a tracer with a mistake that no catalogue has."""
    size = {"width": side[0], "height": side[1], "spp": 32, "seed": 9}
    asked = tracer.Settings(**outside.HOMEWORK | size | settings)
    return screen(tracer.render(scene, asked, steps=zoo.changed(**changes)).rgb)


def clued(values, scene=SCENE, known=None):
    """What is said of a picture that nothing fits, however well something does."""
    known = known or stored()
    found = judged(values, True, CURVES, scene, known, lambda ids, spp: None)
    right, reading = known.rights[0], found.reading
    return reading, clues(
        found, features(reading.rgb, True), right.near(max(right.at)), scene, *straight_and_all(scene)
    )


def test_a_mistake_of_the_materials_is_told_by_objects_that_share_one():
    _, found = clued(outsiders(eval=outside.material_of_the_next))
    assert found.of_material and found.power is None and not found.dim
    assert found.direct_is_dark and {"light.f", "bounce.f"} <= {*found.log}


def test_a_mistake_that_changes_from_place_to_place_excludes_exposure_and_names_the_object():
    _, found = clued(outsiders(light_term=outside.cosine_of_the_lamp))
    assert found.dim and found.worst is not None and "light.cos" in found.log
    assert not found.of_material and found.power is None and not found.direct_is_right
    assert {seen.state for seen in found.objects if seen.name == "lamp"} == {"unseen"}


@pytest.mark.parametrize(
    "changes", [{"film": outside.bent_by_the_root}, {"light_term": outside.without_throughput}], ids=list
)
def test_what_is_too_bright_where_it_is_dark_is_not_laid_to_the_light_sample(changes):
    _, found = clued(outsiders(**changes))
    assert 0.4 < found.power < 0.8 and {"direct", "indirect"} < {*found.log}
    assert not (found.dim or found.direct_is_right or found.direct_is_dark)


def test_a_right_picture_gives_no_clue_to_anything():
    _, found = clued(outsiders())
    assert found.agree[0] >= 0.9 * found.agree[1] and found.dim and found.direct_is_right
    assert not found.direct_is_dark and found.worst is None and found.power is None and not found.of_material
    assert {seen.state for seen in found.objects} <= {"agrees", "unsure", "unseen"}


def test_what_glass_does_leaves_light_samples_and_the_curve_as_they_are():
    scene = loaded("coloured_glass")
    known = album(scene, [bug for bug in suited(scene, ZOO.values()) if bug.id in ("E01", "D10", "A01")])
    values = outsiders({"integrator": "path"}, scene, (128, 80), transmittance=outside.half_absorbed)
    reading, found = clued(values, scene, known)
    assert reading.curve == "srgb" and found.dim and found.direct_is_right
    assert found.log[0] == "hit.transmittance"


@pytest.mark.parametrize(
    ("media", "right", "material", "power"),
    [
        (1, True, False, None),
        (None, True, False, None),
        (1, False, True, None),
        (1, False, False, 0.5),
        (1, False, False, None),
    ],
)
def test_what_is_to_be_logged_next_are_names_of_the_log(media, right, material, power):
    found = SimpleNamespace(direct_is_right=right, of_material=material, power=power)
    names = to_log(found, SimpleNamespace(media=media))
    assert len({*names}) == 3 and {*names} <= call_fields().keys()
