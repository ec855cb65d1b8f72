"""Every lesson holds what it says: numbers from the run, links that land, checks that judge, two languages
in step."""

import re
from collections import Counter
from functools import cache

import numpy as np
import pytest
from cases import slow_but
from spellchecker import SpellChecker
from suite import ROOT

from lessons import answer, glossary, zoo
from lessons.course import about, lesson, lessons
from lessons.html import html
from lessons.lesson import KINDS
from lessons.plain import spelled
from lessons.run import Run
from lessons.words import MOMENT, PLACEHOLDER, TaskWords, blocks, labels
from tracer.events import KINDS as EVENTS

ALL = tuple(lessons())
# Those whose experiments take longest.
LONG = (5, 8, 14, 15, 19, 21, 22)
TASKS = [(number, task) for number in ALL for task in lesson(number).tasks]
each_lesson = pytest.mark.parametrize("number", ALL)
each_run = pytest.mark.parametrize("number", slow_but(ALL, *(n for n in ALL if n not in LONG)))
each_task = pytest.mark.parametrize(
    ("number", "task"), slow_but(TASKS, *(task for task in TASKS if task[0] not in LONG))
)
each_moment = pytest.mark.parametrize(
    ("number", "moment"), [(number, moment) for number in ALL for moment in lesson(number).moments]
)
# A number that a text may say: a whole one up to 10, or one that the front matter allows.
SMALL = re.compile(r"10|\d")
INLINE = re.compile(r"(?<!\$)\$([^$\n]+)\$(?!\$)")
RELATION = re.compile(r"[=<>]|\\(?:le|ge|ne|approx|equiv|propto|iff)\b")
DIGITS = re.compile(r"\d+(?:[.,]\d+)*")
INSIDE = re.compile(r"\$\$.*?\$\$(?:\s*\([\w-]+\))?|\$[^$\n]+\$|`[^`]*`|\{\{[^}]*\}\}|\]\([^)]*\)", re.DOTALL)


@cache
def run(number):
    return Run(lesson(number))


@cache
def checker():
    """The English dictionary and the words of this course."""
    found = SpellChecker()
    own = (ROOT / "tests" / "lessons" / "known_words.txt").read_text(encoding="utf-8").split()
    found.word_frequency.load_words(own)
    return found


def texts(number, language):
    return dict(lesson(number).words[language].texts)


@each_lesson
def test_a_lesson_has_all_that_its_form_asks_for(number):
    it = lesson(number)
    assert 10 <= it.minutes <= 20
    assert it.tasks and it.formulas and it.references
    assert any("bug" in moment.settings for moment in it.moments.values())
    assert set(it.bugs) <= zoo.ZOO.keys()
    for task in it.tasks.values():
        assert task.kind in KINDS
        assert len(task.wrong) >= 3
    for words in it.words.values():
        assert words.title
        assert any(re.search(r"^## (Change it|改一改)$", text, re.MULTILINE) for _, text in words.texts)
        assert list(words.tasks) == list(it.tasks)
        for task in words.tasks.values():
            assert task.ask and len(task.hints) > 1 and task.solution
            assert bool(task.choices) == (it.tasks[task.id].kind == "choice")
            assert all(1 <= k <= len(it.tasks[task.id].wrong) for k in task.wrong)
    assert not set(it.tasks) & {name for words in it.words["en"].tasks.values() for name in words.choices}


@each_lesson
def test_the_languages_are_in_step_block_by_block(number):
    english, chinese = texts(number, "en"), texts(number, "zh")
    assert list(english) == list(chinese)
    for place, text in english.items():
        ours = [(kind, shared) for kind, _, shared in blocks(text)]
        theirs = [(kind, shared) for kind, _, shared in blocks(chinese[place])]
        assert ours == theirs, place


@each_lesson
def test_the_chinese_uses_the_words_of_the_glossary(number):
    chinese = texts(number, "zh")
    for place, text in texts(number, "en").items():
        pairs = zip(blocks(text), blocks(chinese[place]), strict=True)
        for (_, english, _), (_, translated, _) in pairs:
            lacking = glossary.missing(INSIDE.sub(" ", english), translated)
            assert not lacking, f"{place}: {lacking}\n{english}\n{translated}"


@each_lesson
@pytest.mark.parametrize("language", ["en", "zh"])
def test_no_number_stands_in_a_text_that_the_run_should_give(number, language):
    allowed = set(lesson(number).front.get("allow", ()))
    for place, text in texts(number, language).items():
        bare = [
            n for n in DIGITS.findall(INSIDE.sub(" ", text)) if not SMALL.fullmatch(n) and n not in allowed
        ]
        assert not bare, f"{place}: {bare}; fill them in, or allow them in the front matter"


def test_an_option_in_a_line_is_not_broken_after_its_dashes():
    made = html("Use `castray view cornell --bug E01 -o x.png` and `a --> b`.", str)
    assert made.count('<span class="option">--bug</span>') == made.count("<span") == 1
    assert "castray view cornell" in made and "a --&gt; b" in made


@each_run
@pytest.mark.parametrize("language", ["en", "zh"])
def test_every_text_is_filled_in_and_shown_in_the_terminal_and_as_html(number, language):
    for place, text in texts(number, language).items():
        filled = run(number).fill(text)
        assert not PLACEHOLDER.search(filled) and "{{" not in filled, place
        assert html(filled, lambda name: f"at-{name}")
        for kind, content, shared in blocks(filled):
            latex = shared[:1] if kind.startswith("math") else re.findall(r"\$([^$]+)\$", content)
            assert all(spelled(formula) for formula in latex)


@each_moment
def test_a_link_lands_on_the_event_that_it_names(number, moment):
    event, said = run(number).event(moment), dict(lesson(number).moments[moment].lands)
    assert said.get("kind") in {kind.name for kind in EVENTS}
    for name, value in said.items():
        if isinstance(value, (float, int, list)) and not isinstance(value, bool):
            assert np.allclose(event[name], value, rtol=1e-3, atol=1e-6), name
        else:
            assert event[name] == value, name


@each_lesson
def test_every_link_has_its_moment_and_every_moment_its_link(number):
    used = {name for text in texts(number, "en").values() for _, name in MOMENT.findall(text)}
    places = [name for text in texts(number, "en").values() for name, _ in PLACEHOLDER.findall(text)]
    used |= {name.partition(".")[0] for name in places}
    used |= {task.at for task in lesson(number).tasks.values()} | {"start"}
    used |= {task.answer for task in lesson(number).tasks.values() if isinstance(task.answer, str)}
    assert set(lesson(number).moments) <= used
    linked = {name for text in texts(number, "en").values() for _, name in MOMENT.findall(text)}
    assert linked <= set(lesson(number).moments)


@each_task
def test_a_check_accepts_the_right_answer(number, task):
    it = lesson(number).task(task)
    assert answer.judge(run(number), it, answer.spelled(answer.right(run(number), it))).right


@each_task
def test_a_check_refuses_the_plausible_wrong_answers_and_knows_them(number, task):
    it = lesson(number).task(task)
    wrong = answer.wrong(run(number), it)
    verdicts = [answer.judge(run(number), it, answer.spelled(w)) for w in wrong]
    assert verdicts == [answer.Verdict(False, k) for k in range(1, len(wrong) + 1)]


@each_lesson
def test_every_displayed_formula_is_computed_by_a_function_and_proved_by_a_test(number):
    shown = [label for text in texts(number, "en").values() for label in labels(text)]
    assert Counter(shown) == Counter(lesson(number).formulas.keys())
    for formula in lesson(number).formulas.values():
        assert callable(formula.computed), formula.function
        file, _, name = formula.test.partition("::")
        assert f"def {name}(" in (ROOT / file).read_text(encoding="utf-8"), formula.test


@each_lesson
def test_a_formula_in_the_running_text_is_displayed_too_or_is_set_aside(number):
    it = lesson(number)
    displayed = [latex for text in texts(number, "en").values() for latex in labels(text).values()]
    inline = {latex for text in texts(number, "en").values() for latex in INLINE.findall(text)}
    stated = {latex for latex in inline if RELATION.search(latex)}
    assert stated <= {*displayed, *it.front.get("aside", ())}
    assert set(it.front.get("aside", ())) <= stated


@each_lesson
def test_the_english_is_spelled_right(number):
    for place, text in {"title": lesson(number).words["en"].title, **texts(number, "en")}.items():
        words = re.findall(r"[a-z]+(?:'[a-z]+)?", INSIDE.sub(" ", text.replace("’", "'")).lower())
        odd = checker().unknown(word.removesuffix("'s") for word in words if len(word) > 2)
        assert not odd, f"{place}: {sorted(odd)}; if right, add to tests/lessons/known_words.txt"


@each_lesson
def test_a_lesson_names_works_that_are_in_the_list_of_references(number):
    papers = (ROOT / "REFERENCES.md").read_text(encoding="utf-8")
    assert all(f"**{work}**" in papers for work in lesson(number).references)


def test_the_terms_of_the_glossary_are_found_longest_first_and_missed_where_they_lack():
    assert list(glossary.found("Total internal reflection at the surfaces")) == [
        "total internal reflection",
        "surface",
    ]
    assert glossary.missing("the critical angle of a ray", "光线的角") == ["critical angle"]
    assert not glossary.missing("the critical angle of a ray", "光线的临界角")


def test_a_language_that_lags_behind_is_seen():
    whole = "## Head\n\nSee [it](#start): {{n:.1f}} at $x$.\n\nMore."
    for lagging in ("## 头\n\n看[它](#start)：{{n:.1f}}，$x$。", whole.replace("#start", "#other"),
                    whole.replace(":.1f", ":.2f"), whole.replace("$x$", "$y$")):  # fmt: skip
        assert [(k, s) for k, _, s in blocks(whole)] != [(k, s) for k, _, s in blocks(lagging)]
    same = "## 头\n\n在 $x$ 处是 {{n:.1f}}，看[它](#start)。\n\n更多。"
    assert [(k, s) for k, _, s in blocks(whole)] == [(k, s) for k, _, s in blocks(same)]


def test_no_mistake_is_explained_twice():
    explained = Counter(bug for it in lessons().values() for bug in it.bugs)
    assert set(explained.values()) <= {1}
    assert about("S02") == 4 and about(None) is None


def test_texts_of_tasks_are_taken_apart():
    parts = lesson(4).words["en"].body
    assert [part.id for part in parts if isinstance(part, TaskWords)] == list(lesson(4).tasks)
