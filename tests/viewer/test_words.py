"""Every event is put into words, and a dead path says why it carries nothing."""

import numpy as np
import pytest

import tracer
from tracer.events import END_REASONS, KINDS
from viewer.caption import caption, shown, why_dead
from viewer.equation import formulas
from viewer.words import WORDS, Speaker

SAY = Speaker()


@pytest.fixture(scope="module", params=["cornell_unit", "cornell_glass", "furnace", "coloured_glass"])
def pixels(request):
    """A scene, its settings and some recorded pixels."""
    scene = tracer.load(request.param)
    settings = tracer.Settings(width=24, height=24, spp=6, max_depth=7).at_size_of(scene)
    return (
        scene,
        settings,
        [tracer.inspect(scene, settings, x, y) for x in (2, 9, 14, 21) for y in (3, 11, 16, 22)],
    )


def paths(pixels):
    scene, settings, records = pixels
    return [(scene, settings, path) for record in records for path in record.paths]


def test_every_event_has_a_caption_and_every_field_a_value(pixels):
    for scene, _, path in paths(pixels):
        for event in path.events:
            assert caption(event, scene, SAY)
            for field in event.kind.fields:
                assert shown(field, event.values[field.name], scene, SAY)


def test_a_dead_path_says_why_in_one_sentence_and_a_live_one_does_not(pixels):
    for scene, _, path in paths(pixels):
        sentence = why_dead(path, scene, SAY)
        assert bool(sentence) == (not np.any(path.radiance > 0))
        assert sentence.count(". ") == 0


@pytest.mark.slow
def test_the_formula_gives_what_was_recorded(pixels):
    """Substituting the event's own numbers reproduces its result, whatever the event."""
    for _, settings, path in paths(pixels):
        for index in range(len(path.events)):
            shown_formulas = formulas(path, index, settings, SAY)
            assert shown_formulas["symbolic"].startswith("<math")
            assert shown_formulas["differs"] == ""


def test_a_result_that_does_not_follow_is_seen(pixels):
    """The test above can fail: a wrong contribution is shown beside what the formula gives."""
    scene, settings, records = pixels
    for path in (p for r in records for p in r.paths):
        for index, event in enumerate(path.events):
            if np.any(event.values.get("contribution", 0) > 0):
                event.values["contribution"] = event.values["contribution"] * 1.01
                assert formulas(path, index, settings, SAY)["differs"]
                return
    pytest.fail(f"no light anywhere in {scene.name}")


def test_every_kind_and_every_end_has_its_words():
    for kind in KINDS:
        assert SAY(f"kind.{kind.name}")
    for reason in END_REASONS:
        assert SAY(f"caption.end.{reason}") and SAY(f"dead.{reason}")


@pytest.mark.parametrize("language", WORDS)
def test_every_language_has_all_the_words(language):
    assert WORDS[language].keys() == WORDS["en"].keys()
