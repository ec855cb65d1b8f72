"""Every event is put into words, and a dead path says why it carries nothing."""

import re
from string import Formatter

import numpy as np
import pytest

import tracer
from tracer.events import END_REASONS, KINDS
from viewer.caption import caption, shown, why_dead
from viewer.equation import formulas
from viewer.words import LANGUAGES, Speaker, areas, table

SAY = Speaker("en")


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


TABLES = [(area, tables) for area, tables in areas().items() if "en" in tables]


def names(words):
    """The {names} that a text has filled in."""
    return {name for _, name, _, _ in Formatter().parse(words) if name is not None}


@pytest.mark.parametrize(("area", "tables"), TABLES, ids=[area for area, _ in TABLES])
def test_every_key_stands_in_every_language_and_has_the_same_values_filled_in(area, tables):
    assert tables.keys() == LANGUAGES.keys()
    for language, words in tables.items():
        assert words.keys() == tables["en"].keys(), language
        for key, said in words.items():
            assert said.strip() or key.startswith("join."), key
            assert names(said) == names(tables["en"][key]), (language, key)


def test_no_key_stands_in_two_areas():
    for language in LANGUAGES:
        keys = [key for tables in areas().values() for key in tables.get(language, {})]
        assert len(keys) == len(set(keys)) == len(table(language))


@pytest.mark.parametrize("language", LANGUAGES.keys() - {"en"})
def test_every_event_and_field_of_the_schema_is_explained_in_every_language(language):
    declared = {f"event.{kind.name}" for kind in KINDS}
    declared |= {f"field.{kind.name}.{field.name}" for kind in KINDS for field in kind.fields}
    assert areas()["schema"][language].keys() == declared
    choices = {c for kind in KINDS for field in kind.fields for c in field.choices}
    assert {f"choice.{c}" for c in choices} <= table(language).keys()


@pytest.mark.parametrize("language", LANGUAGES.keys() - {"en"})
def test_a_caption_has_words_of_one_language_only(pixels, language):
    """Names of shapes and numbers aside, Chinese sentences have no English in them."""
    scene, say = pixels[0], Speaker(language)
    own = {shape.name for shape in scene.shapes} | set(scene.light_names) | {"m"}
    for scene, _, path in paths(pixels):
        for said in [why_dead(path, scene, say), *(caption(event, scene, say) for event in path.events)]:
            assert not set(re.findall(r"[a-z_]{1,}", re.sub(r"[\d.]+(e[+-]\d+)?", "", said))) - own


def test_a_word_that_one_language_lacks_is_seen():
    """The test above can fail."""
    assert names("{a} and {b}") != names("{a}")
