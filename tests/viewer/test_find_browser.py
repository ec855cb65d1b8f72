"""The Find panel in a real browser: what it shows is what castray query says, and a click leads there."""

import json
import re

import pytest
from suite import castray
from viewers import SMALL

from tracer.trace.asker import Asker
from tracer.trace.breakpoints import condition

pytestmark = pytest.mark.browser

BLOCKED = "kind = 'light' AND NOT visible AND depth >= 1"


@pytest.fixture(scope="module")
def box(tmp_path_factory):
    """A recording, made by the command, of the picture that the viewer shows."""
    place = tmp_path_factory.mktemp("found")
    ran = castray("render", "cornell_unit", *SMALL, "-o", "p.npy", "--record", "box",
                  "--record-level", "events", cwd=place)  # fmt: skip
    assert ran.returncode == 0, ran.stderr
    return place / "box"


@pytest.fixture(scope="module")
def page(small, tab):
    """One tab for all of it, with the Find panel open."""
    opened = tab(small.address)
    opened.get_by_test_id("tab-find").click()
    return opened


@pytest.fixture(scope="module")
def queried(box):
    """What `castray query` answers, without starting Python anew for each question."""
    asker = Asker(box)
    yield lambda text: asker.ask(text, 200)
    asker.close()


def ask(page, text):
    """Type a query and send it."""
    page.get_by_test_id("query").fill(text)
    page.get_by_test_id("query").press("Enter")


def counted(page, **counts):
    """Wait until so many are said to be found."""
    said = "".join(f"[data-{name}='{number}']" for name, number in counts.items())
    page.locator(f"[data-testid=find-found]{said}").wait_for()


def test_before_anything_is_asked_it_says_what_asking_does(page):
    said = page.get_by_test_id("find-status").inner_text()
    assert "32,768 paths" in said and " s" in said
    assert page.get_by_test_id("find-found").count() == 0


def test_a_query_lists_and_marks_what_castray_query_finds(page, box):
    ran = castray("query", box, BLOCKED, "--limit", 200, "--json")
    assert ran.returncode == 0, ran.stderr
    answer = json.loads(ran.stdout)
    ask(page, BLOCKED)
    counted(page, **{k: answer[k] for k in ("events", "paths", "pixels")})
    rows = page.locator("[data-testid=hits] li").all_inner_texts()
    assert len(rows) == 200
    for row, path in zip(rows[:10], answer["found"], strict=False):
        for said in (f"{path['x']}, {path['y']}", f"path {path['sample']}", f"depth {path['depth']}"):
            assert said in row
    assert page.get_by_test_id("legend").is_visible()


def test_a_click_on_a_hit_and_keys_lead_to_path_and_event(page, queried):
    found = queried(BLOCKED)["found"]
    ask(page, BLOCKED)
    page.get_by_test_id("hit-2").click()
    for k, key in ((2, "n"), (3, "n"), (4, "p"), (3, None)):
        stands_at(page, found[k])
        page.locator(f"[data-testid=hit-{k}][aria-current=true]").wait_for()
        if key:
            page.keyboard.press(key)


def stands_at(page, path):
    """Wait until the table shows a found path at its event."""
    table = f"[data-testid=event-table][data-pixel='{path['x']},{path['y']}'][data-path='{path['sample']}']"
    page.locator(f"{table} [data-testid=row-{path['step']}][data-now=true]").wait_for()


def test_pixels_picked_before_come_back(page):
    ask(page, BLOCKED)
    place = page.get_by_test_id("event-table").get_attribute("data-pixel")
    page.get_by_test_id("hit-20").click()
    page.locator(f"[data-testid=event-table]:not([data-pixel='{place}'])").wait_for()
    page.get_by_test_id("pixel-back").click()
    page.locator(f"[data-testid=event-table][data-pixel='{place}']").wait_for()
    page.get_by_test_id("pixel-forward").click()
    page.locator(f"[data-testid=event-table]:not([data-pixel='{place}'])").wait_for()
    page.get_by_test_id("pixel-forward").and_(page.locator(":disabled")).wait_for()


def test_a_wrong_query_shows_where_it_is_wrong_and_the_columns(page):
    ask(page, "depth >= 2 AND pdff < 1e-4")
    assert page.get_by_test_id("find-caret").locator("mark").inner_text() == "pdff"
    said = page.get_by_test_id("find-error").inner_text()
    assert "character 16" in said and "Traceback" not in said
    page.get_by_test_id("find-error").locator("summary").click()
    assert "pdf_bsdf" in page.get_by_test_id("find-error").inner_text()


def test_breakpoints_are_buttons(page, queried):
    for name in ("largest", "self", "negative"):
        answer = queried(condition(name, "events"))
        page.get_by_test_id(f"stop-{name}").click()
        counted(page, **{k: answer[k] for k in ("events", "paths", "pixels")})


def test_an_answer_that_comes_meanwhile_leaves_what_is_being_typed(page, queried):
    field = page.get_by_test_id("query")
    for name in ("negative", "largest"):
        answer = queried(condition(name, "events"))
        page.get_by_test_id(f"stop-{name}").dispatch_event("click")
        field.fill("depth >= 3")
        counted(page, **{k: answer[k] for k in ("events", "paths", "pixels")})
        assert field.input_value() == "depth >= 3"


def test_a_select_shows_its_rows(page, queried):
    text = "SELECT kind, count(*) AS events FROM events GROUP BY kind ORDER BY kind"
    answer = queried(text)
    ask(page, text)
    page.get_by_test_id("find-table").wait_for()
    cells = page.locator("[data-testid=find-table] td").all_inner_texts()
    assert cells == [str(v) for row in answer["rows"] for v in row]


def test_the_brush_selects_what_lies_in_its_bins(page, queried):
    handle = page.get_by_test_id("brush-low")
    last = int(handle.get_attribute("max"))
    handle.fill(str(last - 3))
    handle.dispatch_event("change")
    from playwright.sync_api import expect

    expect(page.get_by_test_id("query")).to_have_value(re.compile(r"luminance\(contribution\) >= "))
    text = page.get_by_test_id("query").input_value()
    counted(page, events=queried(text)["events"])


def test_a_heat_map_lies_over_the_picture_with_its_legend(page, queried):
    page.get_by_test_id("map").select_option("largest")
    page.get_by_test_id("legend-title").filter(has_text="largest").wait_for()
    most = queried("SELECT max(luminance(contribution))::DOUBLE FROM events")["rows"][0][0]
    assert float(page.get_by_test_id("legend-high").inner_text()) == pytest.approx(most, rel=1e-4)
    x, y, value = queried(
        "SELECT x, y, max(luminance(contribution))::DOUBLE AS v FROM events GROUP BY x, y ORDER BY v DESC"
    )["rows"][150]
    picture = page.get_by_test_id("picture").bounding_box()
    side = min(picture["width"], picture["height"])
    left, top = (picture[a] + (picture[b] - side) / 2 for a, b in (("x", "width"), ("y", "height")))
    page.mouse.move(left + (x + 0.5) * side / 64, top + (y + 0.5) * side / 64)
    page.get_by_test_id("hover").filter(has_text=f"({x}, {y})").wait_for()
    shown = page.get_by_test_id("hover").inner_text()
    assert float(shown.rpartition(":")[2]) == pytest.approx(value, rel=1e-3)
    page.get_by_test_id("uncover").click()
    page.get_by_test_id("legend").wait_for(state="detached")
    assert page.get_by_test_id("map").input_value() == ""
