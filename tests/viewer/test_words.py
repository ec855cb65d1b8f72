"""Every event is put into words, and a dead path says why it carries nothing."""

import re
from dataclasses import fields
from string import Formatter

import numpy as np
import pytest
from cases import slow_but
from logs import INNER, OUTER, write_log

import tracer
from lessons import glossary
from lessons.zoo import FAMILIES, ZOO
from tracer.doctor import LAWS, statistics
from tracer.events import END_REASONS, KINDS
from tracer.settings import Settings
from tracer.trace import views
from tracer.trace.jsonl import read_log, schema_text
from tracer.trace.pixels import pixel, without_gaps
from viewer.caption import caption, shown, unit_of, why_dead
from viewer.equation import formulas
from viewer.words import LANGUAGES, Speaker, areas, table

SAY = Speaker("en")


@pytest.fixture(
    scope="module",
    params=slow_but(
        ("cornell_unit", "cornell_glass", "furnace", "coloured_glass"), "coloured_glass", "furnace"
    ),
)
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


def test_what_a_log_need_not_have_is_no_dash_in_a_sentence(tmp_path):
    log = write_log(tmp_path / "mine.jsonl", OUTER, INNER)
    trace = without_gaps(read_log(log, tracer.load("cornell")).trace)
    path = pixel(trace, 3, 5).paths[0]
    said = [caption(e, trace.scene, say) for say in map(Speaker, LANGUAGES) for e in path.events]
    assert len(said) > 10 and not any("–" in text or "?" in text or "nan" in text for text in said)
    told = [formulas(path, index, trace.settings, SAY) for index in range(len(path.events))]
    assert any("?" in row["math"] for one in told for row in one["rows"])  # a factor is missing
    assert not any(one["differs"] for one in told)


def test_one_thing_is_not_said_in_the_plural():
    assert SAY("find.count", events=1, paths=1, pixels=21).startswith("1 event on 1 path of 21 pixels")
    assert "1,001 paths" in SAY("find.count", events=1001, paths=1001, pixels=11)


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
def test_every_law_and_every_bug_is_told_in_every_language(language):
    laws = {f"{what}.{rule.id}" for rule in (*LAWS, *statistics.RULES) for what in ("rule", "law")}
    assert areas()["laws"][language].keys() == laws
    bugs = {f"{what}.{bug}" for bug in ZOO for what in ("bug", "symptom")}
    assert areas()["bugs"][language].keys() == bugs | {f"family.{name}" for name in FAMILIES}
    assert areas()["bug_code"][language].keys() == {f"code.{bug.id}" for bug in ZOO.values() if bug.wrong}


def english():
    """What stands in English in the tables and beside what it explains, by key."""
    said = {key: words for area in ("events", "page") for key, words in areas()[area]["en"].items()}
    for kind in KINDS:
        said[f"event.{kind.name}"] = kind.meaning
        said |= {f"field.{kind.name}.{field.name}": field.meaning for field in kind.fields}
    for rule in (*LAWS, *statistics.RULES):
        said |= {f"rule.{rule.id}": rule.title, f"law.{rule.id}": rule.law}
    for bug in ZOO.values():
        said |= {f"bug.{bug.id}": bug.title, f"symptom.{bug.id}": bug.symptom}
    return {key: re.sub(r"\{\w+\}", "", words) for key, words in said.items()}


def test_chinese_words_are_those_of_the_lessons_glossary():
    chinese = table("zh")
    lacking = {key: glossary.missing(words, chinese[key]) for key, words in english().items()}
    assert {key: terms for key, terms in lacking.items() if terms} == {}


@pytest.mark.parametrize("language", LANGUAGES.keys() - {"en"})
def test_a_caption_has_words_of_one_language_only(pixels, language):
    """Names of shapes and numbers aside, Chinese sentences have no English in them."""
    scene, say = pixels[0], Speaker(language)
    own = {shape.name for shape in scene.shapes} | set(scene.light_names) | {"m"}
    for scene, _, path in paths(pixels):
        for said in [why_dead(path, scene, say), *(caption(event, scene, say) for event in path.events)]:
            assert not set(re.findall(r"[a-z_]{1,}", re.sub(r"[\d.]+(e[+-]\d+)?", "", said))) - own


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_setting_has_a_name_and_every_choice_of_it_too(language):
    say = Speaker(language)
    for field in fields(Settings):
        if field.name not in ("width", "height"):  # always shown as a size
            assert f"dial.{field.name}" in say.words
    said = {say.dialed(value) for value in (True, False, None, "solid_angle", -1)}
    assert not said & {"True", "False", "None", "solid_angle", "-1"}
    differ = say.error(
        "Settings differ: bug E01,D01 and none, jitter on and off, light_sampling area and solid_angle."
    )
    assert "E01,D01" in differ and (language == "en") == ("light_sampling" in differ)


def test_a_word_that_one_language_lacks_is_seen():
    """The test above can fail."""
    assert names("{a} and {b}") != names("{a}")


def test_no_length_is_said_in_a_unit_that_scenes_do_not_have():
    for language in LANGUAGES:
        said = {key: words for key, words in table(language).items() if re.search(r"\} m\b", words)}
        assert said == {}
    assert {unit_of(field) for kind in KINDS for field in kind.fields} >= {"", "1/sr"}
    assert "m" not in {unit_of(field) for kind in KINDS for field in kind.fields}


def test_the_one_light_sample_of_a_path_is_one(pixels):
    for scene, _, path in paths(pixels):
        samples = sum(event.kind.name == "light" for event in path.events)
        said = why_dead(path, scene, SAY)
        assert "1 light sample" not in said
        assert not said or ("its one light sample" in said) == (samples == 1)


def test_the_pages_of_formats_are_chinese_but_for_names():
    tell = Speaker("zh").optional
    pages = views.schema(tell).split("\n宏\n")[0], schema_text(tell)
    assert views.schema(Speaker("en").optional) == views.schema()
    assert schema_text(Speaker("en").optional) == schema_text()
    for page, other in zip(pages, (views.schema(), schema_text()), strict=True):
        lines = [
            line for line in page.splitlines() if line and not line.lstrip().startswith(("{", '"hemisphere'))
        ]
        assert [line for line in lines if not re.search(r"[\u4e00-\u9fff]", line)] == []
        names = [re.match(r"  \S+  ", line)[0] for line in other.splitlines() if re.match(r"  \S+  ", line)]
        assert all(
            f"\n{name}" in page for name in names if name.strip() not in views.MACROS and "(" not in name
        )
