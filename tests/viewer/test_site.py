"""The course as web pages: they open from a file and ask for nothing; what they list is all there is."""

import html
import inspect
import re
from functools import cache

import pytest

import tracer
from lessons.course import lesson, lessons
from tracer.trace.jsonl import schema_text
from viewer.cli import main
from viewer.site import build, formula_map, frame, index, log_format, reference
from viewer.site.build import lesson_pages
from viewer.words import LANGUAGES, Speaker

SMALL = 2  # a lesson whose pictures are small
# Whatever has words and reaches beyond the window, but for what scrolls and the words in the 3D view
OUTSIDE = """width => [...document.querySelectorAll("body, body *")].filter((e) =>
  !e.closest("pre, math, script, .labels") && e.getClientRects().length && e.textContent.trim()
  && e.getBoundingClientRect().right > width + 1)
  .map((e) => e.tagName + " " + e.textContent.slice(0, 60))"""


@cache
def pages_of(solutions):
    return lesson_pages(SMALL, solutions)


@cache
def page(name):
    """A page that is no lesson."""
    return reference.page() if name == "reference.html" else formula_map.page(Speaker(name))


@pytest.mark.browser
def test_a_lesson_opens_from_a_file_and_asks_for_nothing(tmp_path, visit):
    names = build(tmp_path, [SMALL])
    assert {"index.html", "index.zh.html", "lesson-02.html", "lesson-02.zh.html"} <= set(names)
    tab = visit((tmp_path / "lesson-02.html").as_uri(), ready=False)
    tab.locator(".castray-3d[data-place=start]").wait_for()
    assert [address for address in tab.asked if not address.startswith("data:")] == [tab.url]
    assert tab.evaluate("document.fonts.ready.then(() => document.fonts.check('17px \"STIX Two Math\"'))")
    link = tab.locator("article a[href^='#place-']").last
    link.click()
    place = link.get_attribute("href").removeprefix("#place-")
    tab.locator(f".castray-3d[data-place='{place}']").wait_for()
    assert place in lesson(SMALL).moments
    assert "castray view '#scene=" in tab.locator("#command").inner_text()
    tab.get_by_role("link", name="中文").click()
    assert lesson(SMALL).words["zh"].title in tab.title()
    assert tab.errors == []


@pytest.mark.browser
@pytest.mark.parametrize("width", [390, 1280])
def test_no_page_is_wider_than_its_window_on_a_phone_or_a_desk(tmp_path, visit, width):
    pages = pages_of(True) | {f"{tag}.html": page(tag) for tag in LANGUAGES}
    pages |= {index.file_of(tag): index.page(Speaker(tag)) for tag in LANGUAGES}
    for name, text in pages.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
        tab = visit((tmp_path / name).as_uri(), ready=False)
        tab.set_viewport_size({"width": width, "height": 800})
        outside = tab.evaluate(OUTSIDE, width)
        assert outside == [], name
        tab.close()


@pytest.mark.slow
def test_solutions_are_on_the_pages_only_where_they_are_asked_for():
    for solutions in (True, False):
        for tag in LANGUAGES:
            text = pages_of(solutions)[frame.named(f"lesson-{SMALL:02}", tag)]
            assert (f"<summary>{Speaker(tag)('lesson.solution')}</summary>" in text) == solutions
            assert text.count('class="task"') == len(lesson(SMALL).tasks)
            assert "{{" not in text and ":::" not in text
            for label in lesson(SMALL).formulas:
                assert f'href="{frame.named("formulas", tag)}#{SMALL:02}-{label}"' in text


@pytest.mark.slow
def test_every_link_of_the_pages_leads_to_a_page_that_is_built():
    known = {"reference.html"}
    stems = ["index", "formulas", "log-format", *(f"lesson-{number:02}" for number in lessons())]
    known |= {frame.named(stem, tag) for stem in stems for tag in LANGUAGES}
    texts = [*pages_of(True).values(), *map(page, ("reference.html", "en", "zh"))]
    texts += [log_format.page(Speaker(tag)) for tag in LANGUAGES]
    for text in texts:
        targets = re.findall(r'href="(?!data:)([^"#]*)(?:#[^"]*)?"', text)
        assert {target for target in targets if target} <= known


@pytest.mark.slow
@pytest.mark.parametrize("tag", LANGUAGES)
def test_the_map_has_every_formula_with_its_function_and_its_test(tag):
    text, anchors = page(tag), set(re.findall(r'id="([^"]+)"', page("reference.html")))
    for it in lessons().values():
        for label, formula in it.formulas.items():
            assert f'id="{it.number:02}-{label}"' in text
            assert f"<code>{formula.function}</code>" in text and formula.function in anchors
            assert all(part in text for part in formula.test.split("::"))
            assert f"{frame.named(f'lesson-{it.number:02}', tag)}#formula-{label}" in text


def test_the_reference_has_every_public_name_with_its_words_and_its_source():
    text = page("reference.html")
    for name in tracer.__all__:
        thing = getattr(tracer, name)
        assert f'id="tracer.{name}"' in text
        assert reference.said(thing) and reference.source(thing) in text
    assert "Raises TracerError" in inspect.getdoc(tracer.load) and "<b>errors</b>" in text
    for kind in ("hit", "light", "bounce"):
        assert f'id="event-{kind}"' in text


def test_a_folder_that_cannot_be_made_is_one_line(tmp_path, capsys):
    (tmp_path / "file").write_text("in the way", encoding="utf-8")
    with pytest.raises(SystemExit) as ended:
        main(["lesson", "2", "--site", str(tmp_path / "file" / "site")])
    said = capsys.readouterr()
    assert ended.value.code == 2 and said.out == ""
    assert said.err.count("\n") == 1 and "cannot be written" in said.err


def test_the_page_of_the_log_format_says_what_the_command_does_in_its_language():
    for tag in LANGUAGES:
        say = Speaker(tag)
        assert html.escape(schema_text(say.optional)) in log_format.page(say)
        assert f'href="{frame.named("log-format", tag)}"' in index.page(say)
