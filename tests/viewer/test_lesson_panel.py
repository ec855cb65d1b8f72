"""A lesson beside its scene: links move the cursor, answers are judged, help comes in steps."""

import re

import pytest

from lessons.course import lesson, lessons
from lessons.html import mathml

pytestmark = pytest.mark.browser
FOUR = lesson(4)


@pytest.fixture(scope="module")
def server(newcomer):
    """One viewer with lesson 4 open; its reader has done nothing yet."""
    return newcomer("--lesson", "4")


@pytest.fixture(scope="module")
def page(server, tab):
    """One tab of it for all tests."""
    return tab(server.address)


def read(page, number):
    """The lesson is open, its text there."""
    page.locator(f"[data-testid=lesson][data-number='{number}'] .prose").first.wait_for()


def link(page):
    """The address that the page shows."""
    return page.get_by_test_id("castray").get_attribute("data-link")


def reply(page, task, right):
    """What is said to an answer, once it is."""
    box = page.locator(f"[data-testid=reply-{task}][data-right={str(right).lower()}]")
    box.wait_for()
    return box.inner_text()


def test_it_opens_where_the_lesson_begins_and_its_links_move_the_cursor(page):
    read(page, 4)
    assert FOUR.words["en"].title in page.get_by_test_id("lesson-title").inner_text()
    assert link(page) == "scene=pool&spp=8&x=130&y=96&path=0&event=2"
    assert page.locator(".prose a[aria-current]").inner_text() == "a ray that leaves through the window"
    page.get_by_text("the same pixel with this mistake planted").click()
    page.locator("[data-link='scene=pool&spp=8&bug=S02&x=175&y=96&path=1&event=2']").wait_for()
    assert page.locator(".prose a[aria-current]").inner_text() == "the same pixel with this mistake planted"


def test_a_number_is_wrong_then_helped_then_right(page):
    read(page, 4)
    assert page.get_by_test_id("show-radius").count() == 0  # no solution without a try
    page.get_by_test_id("answer-radius").fill("3.75 m")
    page.get_by_test_id("answer-radius").press("Enter")
    assert "You used the sine" in reply(page, "radius", False)
    assert page.get_by_test_id("hints-radius").count() == 1
    page.get_by_test_id("hint-radius").click()
    page.get_by_test_id("hints-radius").nth(1).wait_for()
    page.get_by_test_id("answer-radius").fill("wide")
    page.get_by_test_id("check-radius").click()
    page.get_by_text("'wide' is not a number in m").wait_for()
    page.get_by_test_id("show-radius").click()
    page.get_by_test_id("solution-radius").wait_for()
    page.get_by_test_id("answer-radius").fill("5.67")
    page.get_by_test_id("check-radius").click()
    reply(page, "radius", True)
    assert "1 of 4" in page.get_by_test_id("lesson-about").inner_text()


def test_a_place_elsewhere_is_no_answer(page):
    read(page, 4)
    page.get_by_test_id("check-trapped").click()
    assert "another place" in reply(page, "trapped", False)
    page.get_by_test_id("there-trapped").click()
    page.locator("[data-link='scene=pool&spp=8&x=159&y=96&path=3&event=0']").wait_for()
    page.get_by_test_id("check-trapped").click()
    page.get_by_test_id("show-trapped").wait_for()  # judged now: a try
    assert "another place" not in reply(page, "trapped", False)


def test_everything_is_said_in_the_other_language_at_once(page):
    read(page, 4)
    page.get_by_test_id("language").select_option("zh")
    page.get_by_text("全反射").first.wait_for()
    assert FOUR.words["zh"].title in page.get_by_test_id("lesson-title").inner_text()
    page.get_by_test_id("lesson-list").click()
    page.get_by_test_id("lesson-4").wait_for()
    assert page.locator("[data-testid^=lesson-]").count() == len(lessons())
    assert page.get_by_test_id("lesson-4").locator(".ticks").inner_text() == "✓···"
    page.get_by_test_id("language").select_option("en")
    before = link(page)
    page.get_by_test_id("lesson-2").click()
    read(page, 2)
    page.locator("[data-link^='scene=furnace']").wait_for()
    page.wait_for_url("**/*scene=furnace*")
    page.go_back()  # to where the reader came from
    page.locator(f"[data-link='{before}']").wait_for()
    page.get_by_test_id("lesson-list").click()
    page.get_by_test_id("lesson-4").filter(has_text=FOUR.words["en"].title).click()
    read(page, 4)


def test_the_text_stays_where_it_was_read_and_nothing_hangs_over_its_edge(page):
    read(page, 4)
    page.get_by_test_id("task-friend").scroll_into_view_if_needed()
    scrolled = "() => document.querySelector('.tabbody').scrollTop"
    before = page.evaluate(scrolled)
    page.get_by_test_id("tab-event").click()
    page.get_by_test_id("event-data").wait_for()
    page.get_by_test_id("tab-lesson").click()
    read(page, 4)
    assert before > 500 and page.evaluate(scrolled) == before
    assert page.evaluate("() => document.querySelector('.tabbody').scrollWidth") <= page.evaluate(
        "() => document.querySelector('.tabbody').clientWidth"
    )


def test_a_function_keeps_apart_from_what_stands_around_it():
    space = '<mspace width="0.167em" />'
    assert mathml(r"r = d\tan\theta_c").count(space) == 2
    assert mathml(r"\sin^2\theta") and mathml(r"\sin^2\theta").count(space) == 1
    assert mathml(r"\sin(x)").count(space) == 0
    assert not re.search(r"\\,", mathml(r"\max\left(0, \cos\theta\right)"))
