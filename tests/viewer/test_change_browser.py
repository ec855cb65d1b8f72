"""Change and see, in a browser: what is turned shows at once, and is what the command says with --set."""

import json
import shlex

import pytest
from suite import castray

from viewer.link import parse
from viewer.words import Speaker

pytestmark = pytest.mark.browser

SIZE = ("--size", "32", "32", "--spp", "4", "--max-depth", "5")
START = "scene=cornell_unit&width=32&height=32&spp=4&max_depth=5&x=16&y=20&path=1&event=2"


@pytest.fixture(scope="module")
def viewer(serve):
    """A viewer of a small picture, shared by the tests of this file."""
    return serve("cornell_unit", *SIZE)


@pytest.fixture(scope="module")
def page(viewer, tab):
    """One page for all of them, at the tab of changes."""
    return tab(viewer.address)


@pytest.fixture(autouse=True)
def start(page):
    """Every test starts at the same place of the scene as it is."""
    page.evaluate("link => window.trame.trigger('open', [link])", START)
    linked(page, "x=16&y=20&path=1&event=2")
    page.get_by_test_id("tab-change").click()


def truth(page):
    """What the server knows."""
    return page.evaluate("() => window.trame.trigger('truth')")


def linked(page, text, there=True):
    """Wait until the page's link says so, or does not."""
    page.wait_for_function(
        """([text, there]) => {
          const link = document.querySelector("[data-testid=castray]").dataset.link;
          return decodeURIComponent(link).includes(text) === there; }""",
        arg=[text, there],
    )


def turn(page, call, key, value):
    """Turn a knob as a reader does."""
    knob = page.get_by_test_id(f"{call}-{key}")
    if knob.evaluate("e => e.tagName") == "SELECT":
        knob.select_option(value)
    else:
        knob.evaluate(
            "(e, v) => { e.value = v; for (const k of ['input', 'change']) e.dispatchEvent(new Event(k)); }",
            value,
        )


def shown(page, text):
    """Wait until the link says so, and the picture is complete."""
    linked(page, text)
    page.get_by_test_id("progress").wait_for(state="detached")


def inspected(page):
    """What the command that the panel shows prints."""
    words = shlex.split(page.get_by_test_id("change-command").inner_text())
    at = words.index("--sample")
    done = castray(*words[1:at], *words[at + 2 :], "--json")
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_a_turned_knob_is_what_the_command_says_with_set(page):
    before = page.get_by_test_id("pixel-value").inner_text()
    turn(page, "change", "white.reflectance", "0.4")
    turn(page, "change", "lamp.scale", "2")
    shown(page, "lamp.scale=2")
    after = truth(page)
    assert page.get_by_test_id("pixel-value").inner_text() != before
    assert after["record"] == inspected(page)
    assert {k: after["cursor"][k] for k in ("x", "y", "path")} == {"x": 16, "y": 20, "path": 1}
    assert parse(after["link"]).changes["lamp.scale"] == 2
    page.get_by_test_id("change-reset").click()
    page.wait_for_function(
        "() => !document.querySelector('[data-testid=castray]').dataset.link.includes('set=')"
    )
    assert truth(page)["link"] == START.replace("event=2", f"event={truth(page)['cursor']['event']}")


def test_settings_are_turned_and_what_will_not_do_is_told_in_one_line(page):
    turn(page, "tune", "integrator", "direct")
    turn(page, "tune", "bug", "D10")
    shown(page, "bug=D10")
    assert truth(page)["record"] == inspected(page)
    turn(page, "tune", "spp", "0")
    page.get_by_test_id("message").wait_for()
    assert "spp" in page.get_by_test_id("message").inner_text()
    assert parse(truth(page)["link"]).settings.spp == 4
    page.get_by_test_id("close-message").click()


def test_only_the_newest_of_many_moves_is_painted_to_its_end(page):
    values = [f"{0.2 + 0.05 * k:.2f}" for k in range(10)]
    page.get_by_test_id("change-red.reflectance").evaluate(
        "(e, all) => all.forEach((v) => { e.value = v; e.dispatchEvent(new Event('input')); })", values
    )
    shown(page, "red.reflectance=[0.65")
    there = truth(page)
    assert there["spp_done"] == there["spp"] == 4
    assert there["record"] == inspected(page)
    box = page.get_by_test_id("picture").bounding_box()
    page.mouse.move(box["x"] + box["width"] * 16.5 / 32, box["y"] + box["height"] * 20.5 / 32)
    page.wait_for_function(
        "() => document.querySelector('[data-testid=hover]').textContent.startsWith('(16, 20)')"
    )
    hovered = page.get_by_test_id("hover").inner_text().split(")")[1].split()
    assert [float(v) for v in hovered] == pytest.approx(there["record"]["value"], rel=1e-4)


@pytest.mark.parametrize(
    "asked", [["red.reflectance", 9], ["sensor.fov", 20], ["red.reflectance", None], [[], {}]]
)
def test_what_a_page_may_not_turn_changes_nothing(page, asked):
    before = truth(page)["link"]
    page.evaluate("asked => window.trame.trigger('change', asked)", asked)
    assert truth(page)["link"] == before


def test_the_panel_speaks_chinese(page):
    page.get_by_test_id("language").select_option("zh")
    page.wait_for_selector("html[lang=zh]")
    assert Speaker("zh")("change.albedo", name="white") in page.get_by_test_id("change").inner_text()
    page.get_by_test_id("language").select_option("en")
    page.wait_for_selector("html[lang=en]")


def at_event(page, kind):
    """Stand at the first event of that kind of the selected path; its depth."""
    there = truth(page)
    events = there["record"]["samples"][there["cursor"]["path"]]["events"]
    event = next(e for e in events if e["kind"] == kind)
    page.get_by_test_id(f"mark-{event['step']}").click()
    page.get_by_test_id("tab-what_if").click()
    return event["depth"]


def would_be(page):
    """What the command that the panel shows prints of the path."""
    command = page.get_by_test_id("what-if-command").inner_text()
    done = castray(*shlex.split(command)[1:], "--json")
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)["samples"][0]


def test_a_supposed_path_is_what_the_command_says_and_goes_with_the_link(page):
    depth = at_event(page, "light")
    turn(page, "suppose", f"{depth}.light.1", "0.9")
    linked(page, f"what_if={depth}.light=")
    at_event(page, "bounce")
    turn(page, "suppose", f"{depth}.bounce.0", "25")
    linked(page, f"{depth}.bounce=25,")
    path = would_be(page)
    assert json.loads(page.get_by_test_id("what-if-radiance").get_attribute("data-exact")) == path["radiance"]
    assert page.locator("[data-testid=what-if-events] li").count() == len(path["events"])
    assert page.get_by_test_id("legend-what-if").is_visible()
    assert page.locator(".label.what_if").inner_text() == "what if"
    link, record = truth(page)["link"], truth(page)["record"]
    assert record["samples"][1]["radiance"] != path["radiance"]  # the path as it is stays what it is
    page.get_by_test_id("what-if-reset").click()
    linked(page, "what_if", there=False)
    assert page.get_by_test_id("legend-what-if").count() == 0
    page.evaluate("link => window.trame.trigger('open', [link])", link)
    linked(page, f"{depth}.bounce=25,")
    assert json.loads(page.get_by_test_id("what-if-radiance").get_attribute("data-exact")) == path["radiance"]


def test_another_path_is_not_supposed_of_and_coming_back_finds_it(page):
    depth = at_event(page, "bounce")
    turn(page, "suppose", f"{depth}.bounce.1", "100")
    linked(page, "what_if=")
    page.keyboard.press("ArrowDown")
    linked(page, "what_if", there=False)
    page.keyboard.press("ArrowUp")
    linked(page, "what_if=")
    page.get_by_test_id(f"unsuppose-{depth}.bounce").click()
    linked(page, "what_if", there=False)


def test_the_roulette_is_forced(page):
    there = "scene=cornell_unit&width=32&height=32&spp=4&roulette=0.5&x=16&y=20&path=1&event=0"
    page.evaluate("link => window.trame.trigger('open', [link])", there)
    linked(page, "roulette=0.5&x=16")
    depth = at_event(page, "roulette")
    survived = page.get_by_test_id(f"suppose-{depth}.roulette").input_value() == "survive"
    turn(page, "suppose", f"{depth}.roulette", "stop" if survived else "survive")
    linked(page, f"{depth}.roulette=")
    played = [e for e in would_be(page)["events"] if e["kind"] == "roulette" and e["depth"] == depth]
    assert played[0]["survived"] != survived


@pytest.mark.parametrize(
    "asked", [["0.bounce.0", 20], ["9.light.1", 0.5], ["0.light.7", 0.5], ["0.light.1", 2], [{}, []]]
)
def test_what_a_page_may_not_suppose_changes_nothing(page, asked):
    at_event(page, "light")
    page.evaluate("asked => window.trame.trigger('suppose', asked)", asked)
    assert "what_if" not in truth(page)["link"]
