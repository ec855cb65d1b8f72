"""The doctor's panel: what it shows is what castray doctor says."""

import json

import numpy as np
import pytest
from suite import castray
from viewers import SMALL

import tracer
from viewer import examining

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def page(serve, tab):
    """One tab of one viewer for all stories."""
    return tab(serve("cornell_unit", *SMALL, "--bug", "E01").address)


def examine(page):
    """Open the panel and have the picture examined: two clicks."""
    page.get_by_test_id("tab-doctor").click()
    page.get_by_test_id("doctor-examine").click()
    page.get_by_test_id("doctor-verdict").wait_for()


def at_event(page, first):
    """Wait until the reader stands at what a finding names."""
    table = f"[data-pixel='{first['x']},{first['y']}'][data-path='{first['sample']}']"
    page.locator(f"{table} [data-testid=row-{first['step']}][data-now=true]").wait_for()


def test_the_panel_shows_what_castray_doctor_says(page):
    ran = castray("doctor", "cornell_unit", *SMALL, "--bug", "E01", "--json")
    assert ran.returncode == 1, ran.stderr
    said = json.loads(ran.stdout)
    examine(page)
    for k, finding in enumerate(said["findings"]):
        if finding["follows"] is not None:
            continue
        card = page.get_by_test_id(f"finding-{k}")
        assert card.get_attribute("data-rule") == finding["rule"]
        assert finding["bug"] in card.get_attribute("data-bug")
        for name in ("count", "checked"):
            assert int(card.get_attribute(f"data-{name}")) == finding[name]
        for name in ("recorded", "right"):
            exact = page.get_by_test_id(f"finding-{name}-{k}").get_attribute("data-exact")
            assert json.loads(exact) == finding[name]
        page.get_by_test_id(f"finding-event-{k}").click()
        at_event(page, finding["first"])
    for name, state in (("clean", "clean"), ("untestable", "not_testable")):
        rules = page.get_by_test_id(f"doctor-{name}").get_attribute("data-rules")
        assert int(rules) == sum(rule["state"] == state for rule in said["rules"])
    page.get_by_test_id("finding-where-0").click()
    page.get_by_test_id("legend-title").filter(has_text=said["findings"][0]["title"]).wait_for()
    page.get_by_test_id("uncover").click()


def test_a_right_picture_breaks_no_law(page):
    page.evaluate(
        "link => window.trame.trigger('open', [link])", "scene=furnace&width=32&height=32&spp=4&x=1&y=1"
    )
    page.get_by_test_id("finding-0").wait_for(state="detached")
    examine(page)
    assert page.get_by_test_id("doctor-verdict").inner_text() == "No law is broken."


def test_what_is_examined_lies_all_over_the_picture_and_is_not_too_much():
    small = tracer.Settings(width=64, height=64, spp=8)
    few, pixels = examining.planned(small)
    assert few == small and np.array_equal(pixels, np.arange(64 * 64))
    large = tracer.Settings(width=512, height=256, spp=100)
    few, pixels = examining.planned(large)
    assert few.spp == 16 and pixels.size == np.unique(pixels).size == examining.MOST_PATHS // 16
    of_tiles = np.bincount((pixels // 512 // 32) * 16 + pixels % 512 // 32)
    assert of_tiles.size == 8 * 16 and of_tiles.min() > 0.8 * of_tiles.mean()
