"""The viewer in a real browser: what it shows, and where clicks, keys and links lead."""

import json
from urllib.parse import urlsplit

import pytest
from suite import castray
from viewers import SMALL

from tracer.events import KINDS
from viewer.words import Speaker

pytestmark = pytest.mark.browser

# What the event panel shows, every digit: {field: value}
SHOWN = """
() => Object.fromEntries([...document.querySelectorAll("[data-testid=event-data] > div")].map(
  (row) => [row.dataset.testid.slice(6), JSON.parse(row.querySelector("dd").dataset.exact)]))
"""
# Whatever is drawn outside the page, or outside the part of it that scrolls
OUTSIDE = """
() => [...document.querySelectorAll("button, input, canvas, output, h1, h2, th, dt, dd, .number")].filter(
  (e) => {
  const box = e.getBoundingClientRect(), scrolls = e.closest(".tabbody, .events, .scroll");
  const frame = (scrolls || document.documentElement).getBoundingClientRect();
  const aside = box.right > frame.right + 1 || box.left < frame.left - 1;
  return box.width && !e.closest(".track") && (aside || (!scrolls && box.bottom > frame.bottom + 1));
}).map((e) => (e.dataset.testid || e.className || e.tagName) + " " + e.textContent.slice(0, 40))
"""


def truth(page):
    """What the server knows."""
    return page.evaluate("() => window.trame.trigger('truth')")


def shows(page, **place):
    """Wait until the table and the fields say that the reader stands there."""
    page.wait_for_function(
        """place => {
          const table = document.querySelector("[data-testid=event-table]");
          const now = table.querySelector("[data-now=true]");
          const [x, y] = table.dataset.pixel.split(",").map(Number);
          const event = now && Number(now.dataset.testid.slice(4));
          const here = {x, y, path: Number(table.dataset.path), event};
          return Object.entries(place).every(([k, v]) => here[k] === v);
        }""",
        arg=place,
    )


def stands_at(page, **place):
    """Wait until the table, the fields and the server agree that the reader stands there."""
    shows(page, **place)
    cursor = truth(page)["cursor"]
    assert {k: cursor[k] for k in place} == place


def fill(page, x, y):
    """Pick a pixel by the fields."""
    page.get_by_test_id("pixel-x").fill(str(x))
    page.get_by_test_id("pixel-x").press("Enter")
    stands_at(page, x=x)
    page.get_by_test_id("pixel-y").fill(str(y))
    page.get_by_test_id("pixel-y").press("Enter")
    stands_at(page, x=x, y=y)
    page.get_by_test_id("pixel-y").blur()


def inspected(x, y):
    """`castray inspect --json` of a pixel."""
    ran = castray("inspect", "cornell_unit", "--pixel", x, y, *SMALL, "--json")
    assert ran.returncode == 0, ran.stderr
    return json.loads(ran.stdout)


@pytest.fixture
def page(small, visit):
    """The shared viewer in a new tab; nothing may be complained of in its console."""
    opened = visit(small.address)
    yield opened
    assert opened.errors == []


def test_the_page_opens_with_requests_to_this_machine_only(page, small):
    page.wait_for_timeout(1500)
    hosts = {urlsplit(url).netloc for url in page.asked if not url.startswith(("data:", "blob:"))}
    assert hosts == {f"127.0.0.1:{small.port}"}


def test_the_key_is_not_in_the_address_bar(page, small):
    page.wait_for_url(f"http://127.0.0.1:{small.port}/#scene=cornell_unit*")
    assert small.key not in page.url
    assert small.key not in page.evaluate(
        "() => JSON.stringify([{...localStorage}, {...sessionStorage}, document.cookie])"
    )


def test_a_telling_pixel_is_open_at_the_start_and_a_hint_says_what_to_do(serve, visit):
    page = visit(serve("cornell_unit", *SMALL).address)
    assert page.get_by_test_id("hint").is_visible()
    assert page.locator("[data-now=true]").count() == 1
    fill(page, 10, 10)
    page.get_by_test_id("hint").wait_for(state="detached")


def test_a_click_picks_the_pixel_under_it_and_its_brightest_path(page):
    box = page.get_by_test_id("picture").bounding_box()
    page.mouse.click(box["x"] + box["width"] * 20.5 / 64, box["y"] + box["height"] * 40.5 / 64)
    stands_at(page, x=20, y=40, event=0)
    paths = truth(page)["record"]["samples"]
    given = [0.2126 * r + 0.7152 * g + 0.0722 * b for r, g, b in (p["radiance"] for p in paths)]
    assert truth(page)["cursor"]["path"] == given.index(max(given))


def test_zoomed_in_a_click_picks_the_pixel_under_it(page):
    box = page.get_by_test_id("picture").bounding_box()
    x, y = box["x"] + box["width"] * 48.5 / 64, box["y"] + box["height"] * 24.5 / 64
    page.mouse.move(x, y)
    for _ in range(6):
        page.mouse.wheel(0, -100)
    page.mouse.click(x, y)
    stands_at(page, x=48, y=24)


def test_the_fields_pick(page):
    fill(page, 33, 50)
    assert page.get_by_test_id("pixel-x").input_value() == "33"


@pytest.mark.parametrize("x", ["64", "-1", "1e9"])
def test_a_pixel_outside_the_picture_is_refused_in_one_line(page, x):
    before = truth(page)["cursor"]
    page.get_by_test_id("pixel-x").fill(x)
    page.get_by_test_id("pixel-x").press("Enter")
    message = page.get_by_test_id("message")
    message.wait_for()
    assert "63" in message.inner_text() and "Traceback" not in message.inner_text()
    assert truth(page)["cursor"] == before
    assert page.get_by_test_id("pixel-x").input_value() == str(before["x"])
    page.get_by_test_id("close-message").click()
    message.wait_for(state="detached")


def test_forward_and_back_over_a_whole_path(page):
    fill(page, 30, 45)
    page.keyboard.press("Home")
    last = page.locator("[data-testid=event-table] tbody tr").count() - 1
    texts = []
    for event in range(last):
        stands_at(page, event=event)
        texts.append(page.get_by_test_id("caption").inner_text())
        page.keyboard.press("ArrowRight")
    stands_at(page, event=last)
    page.keyboard.press("ArrowRight")
    stands_at(page, event=last)
    for event in reversed(range(last)):
        page.keyboard.press("ArrowLeft")
        stands_at(page, event=event)
        assert page.get_by_test_id("caption").inner_text() == texts[event]


def test_keys_and_buttons_do_the_same(page):
    fill(page, 30, 45)
    for key, button, place in (
        ("Home", "first", {"event": 0}),
        ("End", "last", None),
        ("ArrowLeft", "previous", None),
        ("ArrowRight", "next", None),
        ("ArrowUp", "up", None),
        ("ArrowDown", "down", None),
    ):
        start = "scene=cornell_unit&width=64&height=64&spp=8&max_depth=6&x=30&y=45&path=3&event=2"
        page.evaluate("link => window.trame.trigger('open', [link])", start)
        page.keyboard.press(key)
        by_key = truth(page)["cursor"]
        assert place is None or by_key["event"] == place["event"]
        assert by_key != {"x": 30, "y": 45, "path": 3, "event": 2}
        page.evaluate("link => window.trame.trigger('open', [link])", start)
        page.get_by_test_id(button).click()
        assert truth(page)["cursor"] == by_key


def test_space_plays_to_the_end_of_the_path_and_pauses(page):
    fill(page, 30, 45)
    page.keyboard.press("Home")
    page.keyboard.press("Space")
    shows(page, event=1)
    shows(page, event=2)
    page.keyboard.press("Space")
    page.wait_for_timeout(300)
    at = truth(page)["cursor"]["event"]
    page.wait_for_timeout(1200)
    assert truth(page)["cursor"]["event"] == at


def test_rows_marks_and_bars_lead_to_their_event_and_path(page):
    fill(page, 30, 45)
    page.get_by_test_id("row-1").click()
    stands_at(page, event=1)
    page.get_by_test_id("mark-0").click()
    stands_at(page, event=0)
    box = page.get_by_test_id("bars").bounding_box()
    page.mouse.click(box["x"] + box["width"] * 5.5 / 8, box["y"] + box["height"] / 2)
    stands_at(page, path=5, event=0)


OTHERWISE = {f.name: f.otherwise for kind in KINDS for f in kind.fields if f.otherwise is not None}


def test_the_numbers_shown_are_those_of_castray_inspect(page):
    fill(page, 21, 37)
    record = inspected(21, 37)
    assert truth(page)["record"] == record
    page.get_by_test_id("tab-event").click()
    for k, sample in enumerate(record["samples"][:4]):
        page.evaluate("k => window.trame.trigger('path', [k])", k)
        for event in sample["events"]:
            page.evaluate("k => window.trame.trigger('event', [k])", event["step"])
            stands_at(page, path=k, event=event["step"])
            shown = page.evaluate(SHOWN)
            for name, value in event.items():
                if name in shown:
                    assert shown[name] == value, name
                elif name not in ("kind", "step", "depth"):
                    # Means nothing here, or is what it is where the scene has no such thing.
                    assert value is None or set(value) in ({None}, {OTHERWISE.get(name)}), name
    value = json.loads(page.get_by_test_id("pixel-value").get_attribute("data-exact"))
    assert value == record["value"]


def test_the_ledger_adds_up_and_shows_the_pixel(page):
    fill(page, 21, 37)
    page.get_by_test_id("tab-ledger").click()
    assert (
        json.loads(page.get_by_test_id("ledger-pixel").get_attribute("data-exact"))
        == truth(page)["record"]["value"]
    )
    for check in ("ledger-pixel-check", "ledger-path-check"):
        assert page.get_by_test_id(check).inner_text().startswith("✓")


def test_the_equation_has_numbers_and_the_result(page):
    fill(page, 21, 37)
    page.get_by_test_id("tab-equation").click()
    for step, name in enumerate(
        e["kind"] for e in truth(page)["record"]["samples"][truth(page)["cursor"]["path"]]["events"]
    ):
        page.get_by_test_id(f"row-{step}").click()
        stands_at(page, event=step)
        assert page.locator("[data-testid=equation-symbolic] math").count() == 1
        if name in ("hit", "light", "bounce"):
            assert page.locator(".channel math").count() == 3
            assert page.get_by_test_id("equation-result").inner_text().split()
    assert page.evaluate("() => document.fonts.check('17px \"STIX Two Math\"')")


def test_hovering_shows_the_linear_value(page):
    page.get_by_test_id("progress").wait_for(state="detached")
    fill(page, 20, 40)
    value = truth(page)["record"]["value"]
    box = page.get_by_test_id("picture").bounding_box()
    page.mouse.move(box["x"] + box["width"] * 20.5 / 64, box["y"] + box["height"] * 40.5 / 64)
    page.wait_for_function(
        "() => document.querySelector('[data-testid=hover]').textContent.startsWith('(20, 40)')"
    )
    shown = [float(v) for v in page.get_by_test_id("hover").inner_text().split(")")[1].split()]
    assert shown == pytest.approx(value, rel=1e-4)


def test_a_dead_path_says_why(page):
    for x in range(0, 64, 7):
        fill(page, x, 60)
        for k, sample in enumerate(truth(page)["record"]["samples"]):
            if not any(sample["radiance"]):
                page.evaluate("k => window.trame.trigger('path', [k])", k)
                page.get_by_test_id("why-dead").wait_for()
                assert "carries nothing" in page.get_by_test_id("why-dead").inner_text()
                return
    pytest.fail("no dead path found")


def test_a_link_opened_in_a_new_server_lands_on_the_same_event(page, serve, visit):
    fill(page, 25, 41)
    page.keyboard.press("ArrowDown")
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowRight")
    there = truth(page)
    page.wait_for_function("link => location.hash.slice(1) === link", arg=there["link"])
    other = visit(serve(page.url).address)
    found = truth(other)
    assert found["cursor"] == there["cursor"]
    assert found["record"] == there["record"]
    assert other.errors == []


def test_a_link_pasted_into_the_same_server_is_followed(page, visit, small):
    fill(page, 25, 41)
    link = "scene=furnace&spp=4&max_depth=3&x=5&y=6&path=1&event=2"
    other = visit(f"http://127.0.0.1:{small.port}/#{link}")
    assert truth(other)["link"] == link
    assert other.get_by_test_id("scene").inner_text() == "furnace"
    stands_at(other, x=5, y=6, path=1, event=2)
    other.evaluate("link => { location.hash = link; }", "scene=nowhere&x=1&y=1")
    other.get_by_test_id("message").wait_for()
    assert "furnace" in other.get_by_test_id("message").inner_text()
    back = " ".join(SMALL).replace("--", "")
    assert back == "size 64 64 spp 8 max-depth 6"
    start = "scene=cornell_unit&width=64&height=64&spp=8&max_depth=6&x=30&y=45"
    other.evaluate("link => window.trame.trigger('open', [link])", start)
    stands_at(other, x=30, y=45)


def test_a_second_tab_takes_over_and_the_first_may_take_back(page, visit, small):
    second = visit(f"http://127.0.0.1:{small.port}/")
    page.get_by_test_id("taken-over").wait_for()
    assert second.get_by_test_id("taken-over").count() == 0
    before = truth(page)["cursor"]
    page.keyboard.press("ArrowDown")
    assert truth(page)["cursor"] == before
    page.get_by_test_id("take-back").click()
    page.get_by_test_id("taken-over").wait_for(state="detached")
    second.get_by_test_id("taken-over").wait_for()
    assert second.errors == []


@pytest.mark.parametrize("size", [(1500, 900), (1280, 720)])
def test_nothing_is_cut_off(page, size):
    page.set_viewport_size({"width": size[0], "height": size[1]})
    page.wait_for_timeout(300)
    for tab in "event equation ledger why vertex find doctor change what_if".split():
        page.get_by_test_id(f"tab-{tab}").click()
        if tab in ("why", "vertex"):  # filled when they are opened
            page.get_by_test_id(tab).wait_for()
        outside = page.evaluate(OUTSIDE)
        assert outside == []


def test_on_a_low_window_the_tabs_reach_down_to_its_end(page):
    page.set_viewport_size({"width": 1280, "height": 720})
    box = page.locator(".tabbody").bounding_box()
    assert box["height"] > 720 / 2 and 720 - box["y"] - box["height"] < 20
    assert page.locator(".events .what").first.bounding_box()["width"] > 300


LEFT = ".left > :not(.picture), .picture > :not(.photo), .photo > canvas, .photo > .hover"
APART = f"""() => [...document.querySelectorAll("{LEFT}")].filter((e) => e.offsetHeight)
  .map((e) => e.getBoundingClientRect()).sort((a, b) => a.top - b.top)
  .every((box, k, all) => !k || box.top >= all[k - 1].bottom - 1)"""


def test_nothing_on_the_left_lies_over_another_however_much_is_told_there(page):
    page.set_viewport_size({"width": 1280, "height": 720})
    for words in (0, 60, 200):
        told = "document.querySelector('.left').prepend(document.createElement('p')); "
        page.evaluate(told + f"document.querySelector('.left > p').textContent = 'long '.repeat({words})")
        page.wait_for_timeout(200)
        assert page.evaluate(APART)
        assert page.locator(".photo > canvas").bounding_box()["height"] >= 96


def test_a_word_in_the_3d_view_stands_only_where_what_it_names_is_seen(page):
    fill(page, 30, 45)
    seen = page.locator(".stage .label:not([hidden])")
    page.keyboard.press("Home")  # the camera stands before the box, outside the view
    stands_at(page, event=0)
    page.wait_for_function("() => document.querySelectorAll('.stage .label:not([hidden])').length === 0")
    page.keyboard.press("ArrowRight")
    stands_at(page, event=1)
    seen.first.wait_for()
    assert seen.count() == 2  # n and wo


def test_the_browser_chooses_the_language_and_the_reader_another_that_is_kept(browser, small):
    with browser.new_context(locale="zh-CN") as chinese:
        page = chinese.new_page()
        page.goto(small.address)
        page.wait_for_selector("html[data-ready][lang=zh]")
        start = "scene=cornell_unit&width=64&height=64&spp=8&max_depth=6&x=30&y=45&path=3&event=2"
        page.evaluate("link => window.trame.trigger('open', [link])", start)
        stands_at(page, x=30, y=45, path=3, event=2)
        assert page.get_by_test_id("tab-event").inner_text() == Speaker("zh")("ui.tab_event")
        kind, field = KINDS[2], "contribution"
        meaning = page.get_by_test_id(f"field-{field}").locator("small")
        assert meaning.inner_text() == Speaker("zh").meaning(kind, field)
        link = truth(page)["link"]
        page.get_by_test_id("language").select_option("en")
        page.wait_for_selector("html[lang=en]")
        assert meaning.inner_text() == kind.field(field).meaning
        assert truth(page)["link"] == link == start  # it names no language
        page.reload()
        page.wait_for_selector("html[data-ready][lang=en]")
        assert page.get_by_test_id("language").input_value() == "en"
