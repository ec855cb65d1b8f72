"""The Compare panel in a real browser: what it shows is what castray diff and castray twin say."""

import io
import json
from contextlib import redirect_stdout
from dataclasses import replace

import numpy as np
import pytest

import tracer
from lessons.zoo import planted
from tracer import twin
from tracer.testing import compare
from tracer.trace import gather
from viewer.cli import main
from viewer.comparing import first

pytestmark = pytest.mark.browser

SIDE = 32
SMALL = ("--size", SIDE, SIDE, "--spp", 4, "--max-depth", 4)


def said(*words):
    """The JSON document that a command prints."""
    out = io.StringIO()
    with redirect_stdout(out), pytest.raises(SystemExit):
        main([str(word) for word in words])
    return json.loads(out.getvalue())


@pytest.fixture(scope="module")
def page(serve, tab):
    """One tab with the Compare panel open, the right tracer beside D01."""
    opened = tab(serve("cornell_unit", *map(str, SMALL), "--compare", "D01").address)
    opened.get_by_test_id("tab-compare").click()
    opened.get_by_test_id("progress").wait_for(state="detached")
    return opened


@pytest.fixture(scope="module")
def pictures(tmp_path_factory):
    """What the commands say of both pictures."""
    place = tmp_path_factory.mktemp("pictures")
    a, b = (place / name for name in ("a.exr", "b.exr"))
    for file, words in ((a, ()), (b, ("--bug", "D01"))):
        said("render", "cornell_unit", *SMALL, *words, "-o", file, "--json")
    one, other = tracer.read(a), tracer.read(b)
    look = first.pixel(one, other, compare(one, other), same_numbers=True)
    return said("diff", a, b, "--json") | {"apart": one.rgb - other.rgb, "first": look}


def test_the_numbers_are_those_of_castray_diff(page, pictures):
    judged = page.get_by_test_id("compare-numbers")
    judged.and_(page.locator(f"[data-exact*='{pictures['errors']['rmse']!r}']")).wait_for(state="attached")
    shown = json.loads(judged.get_attribute("data-exact"))
    for key in ("same", "p_value", "errors", "test"):
        assert shown[key] == pytest.approx(pictures[key]) if key == "p_value" else shown[key] == pictures[key]


def test_the_wipe_shows_the_other_picture_to_its_right(page):
    page.get_by_test_id("view-wipe").click()
    page.get_by_test_id("wipe").wait_for()
    shots = []
    for share in ("0", "1"):
        page.get_by_test_id("wipe").fill(share)
        page.wait_for_timeout(100)
        shots.append(page.get_by_test_id("picture").evaluate("c => c.toDataURL()"))
    assert shots[0] != shots[1]
    page.get_by_test_id("wipe").fill("0.5")
    box = page.get_by_test_id("picture").bounding_box()
    middle, low = box["x"] + box["width"] / 2, box["y"] + 0.7 * box["height"]
    side = min(box["width"], box["height"])
    place = page.get_by_test_id("event-table").get_attribute("data-pixel")
    page.mouse.move(middle, low)
    page.mouse.down()
    page.mouse.move(middle + side / 4, low, steps=3)
    page.mouse.up()
    assert float(page.get_by_test_id("wipe").input_value()) == pytest.approx(0.75, abs=0.02)
    assert page.get_by_test_id("event-table").get_attribute("data-pixel") == place  # which is no pick
    page.get_by_test_id("view-alone").click()
    page.get_by_test_id("wipe").wait_for(state="detached")
    page.wait_for_timeout(100)


def test_hovering_the_difference_tells_the_numbers_of_the_pixel(page, pictures):
    apart = np.abs(pictures["apart"]).max(axis=2)
    apart[: SIDE // 3] = 0.0  # where buttons lie over the picture
    y, x = np.unravel_index(np.argmax(apart), apart.shape)
    page.get_by_test_id("view-difference").click()
    page.get_by_test_id("legend-title").filter(has_text="a less b").wait_for()
    box = page.get_by_test_id("picture").bounding_box()
    side = min(box["width"], box["height"])
    left, top = (box[a] + (box[b] - side) / 2 for a, b in (("x", "width"), ("y", "height")))
    page.mouse.move(left + (x + 0.5) * side / SIDE, top + (y + 0.5) * side / SIDE)
    page.get_by_test_id("hover").filter(has_text=f"({x}, {y})").wait_for()
    value = float(page.get_by_test_id("hover").inner_text().rpartition(":")[2])
    assert abs(value) == pytest.approx(apart[y, x], rel=1e-3)
    for view in ("ratio", "z"):
        page.get_by_test_id(f"view-{view}").click()
        page.locator(f"[data-testid=view-{view}].now").wait_for()
    page.get_by_test_id("uncover").click()


def test_the_path_parts_from_its_twin_where_castray_twin_says(page, pictures):
    x, y = pictures["first"]
    page.get_by_test_id("compare-worst").click()
    page.locator(f"[data-testid=event-table][data-pixel='{x},{y}']").wait_for()
    page.get_by_test_id("parting-0").click()
    page.locator("[data-testid=parting-0].now").wait_for()
    sample = int(page.get_by_test_id("event-table").get_attribute("data-path"))
    settings = tracer.Settings(width=SIDE, height=SIDE, spp=4, max_depth=4)
    scene, wrong = tracer.load("cornell_unit"), replace(settings, bug="D01")
    twins = [gather(scene, s, planted(s), np.array([y * SIDE + x])).take([sample]) for s in (settings, wrong)]
    there = twin.compare(*twins, ("a", "b"), most=1).largest[0]
    mine, its = there.steps
    page.keyboard.press("Home")
    page.get_by_test_id("compare-go").click()
    page.locator(f"[data-testid=row-{mine}][data-now=true]").wait_for()
    assert int(page.get_by_test_id("compare-parting").get_attribute("data-step")) == mine
    page.keyboard.press("End")
    page.locator(f"[data-testid=row-{mine}]:not([data-now=true])").wait_for()
    page.keyboard.press("d")
    page.locator(f"[data-testid=row-{mine}][data-now=true]").wait_for()
    assert "parts" in page.get_by_test_id(f"mark-{mine}").get_attribute("class")
    assert "parts" in page.get_by_test_id(f"twin-mark-{its}").get_attribute("class")
    assert page.get_by_test_id("legend-twin").is_visible()
    names = page.locator("[data-testid=compare-fields] tbody th").all_inner_texts()
    assert set(names) == {number.field.name for number in there.numbers}


def test_where_the_pictures_paths_part_is_what_castray_twin_says(page):
    page.get_by_test_id("compare-search").click()
    page.get_by_test_id("compare-causes").wait_for()
    twins = said("twin", "cornell_unit", *SMALL, "--bug", "D01", "--json")
    shown = [
        (int(row.get_attribute("data-pairs")), row.get_attribute("data-what"))
        for row in page.locator("[data-testid=compare-causes] button").all()
    ]
    assert shown == [(cause["pairs"], cause["what"]) for cause in twins["causes"]]
    page.get_by_test_id("cause-0").click()
    at = twins["causes"][0]["example"]
    table = f"[data-pixel='{at['x']},{at['y']}'][data-path='{at['sample']}']"
    page.locator(f"{table} [data-testid=row-{at['steps'][0]}][data-now=true]").wait_for()


def test_a_link_keeps_what_is_compared_with(page):
    link = "scene=cornell_unit&width=16&height=16&spp=2&x=5&y=9&compare=E01"
    page.evaluate("link => window.trame.trigger('open', [link])", link)
    page.locator("[data-testid=castray][data-link*='x=5'][data-link*='compare=E01']").wait_for()
    assert page.get_by_test_id("rival").input_value() == "E01"
    page.get_by_test_id("compare-verdict").wait_for()
    page.get_by_test_id("share").locator("summary").click()
    assert "compare=E01" in page.get_by_test_id("share-link").input_value()
    page.keyboard.press("Escape")


def test_another_bug_is_chosen_and_compared(page):
    page.get_by_test_id("rival").select_option("D10")
    page.get_by_test_id("compare-b").wait_for()
    page.get_by_test_id("compare-verdict").wait_for()
    page.evaluate("window.trame.trigger('tune', ['roulette', '5'])")  # which is refused, and nothing is lost
    page.get_by_test_id("close-message").click()
    page.get_by_test_id("compare-verdict").wait_for()
    page.get_by_test_id("rival").select_option("")
    page.get_by_test_id("compare-verdict").wait_for(state="detached")
    page.get_by_test_id("twin-timeline").wait_for(state="detached")
