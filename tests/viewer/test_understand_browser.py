"""From a pixel to its reasons in a browser: what is shown is what the commands say, and clicks lead there."""

import json

import numpy as np
import pytest
from suite import castray

pytestmark = pytest.mark.browser

SIZE = ("--size", "64", "64", "--spp", "8", "--max-depth", "6")
START = "scene=cornell_unit&width=64&height=64&spp=8&max_depth=6&x=30&y=45&path=0&event=0"


@pytest.fixture(scope="module")
def page(serve, tab):
    """One tab of one viewer for all tests of this file."""
    return tab(serve("cornell_unit", *SIZE).address)


@pytest.fixture(scope="module")
def inspected():
    """`castray inspect --why --json` of the pixel where every test starts."""
    return json.loads(castray("inspect", "cornell_unit", "--pixel", 30, 45, *SIZE, "--why", "--json").stdout)


@pytest.fixture(autouse=True)
def start(page):
    """Every test starts at the same place."""
    open_link(page, START)


def open_link(page, link):
    """Turn to what a link says."""
    page.evaluate("link => window.trame.trigger('open', [link])", link)
    page.locator(f"[data-testid=castray][data-link='{link}']").wait_for()


def stands_at(page, path, event):
    """Wait until the table shows that path and event as the ones of now."""
    page.locator(
        f"[data-testid=event-table][data-path='{path}'] [data-testid=row-{event}][data-now=true]"
    ).wait_for()


def exact(page, name):
    """The numbers behind what is shown, every digit."""
    return json.loads(page.get_by_test_id(name).get_attribute("data-exact"))


def test_the_waterfall_adds_up_and_its_bars_lead_to_the_largest_contribution(page, inspected):
    page.get_by_test_id("tab-ledger").click()
    names = page.locator("[data-testid^='bar-']").evaluate_all("all => all.map((e) => e.dataset.testid)")
    total = [sum(exact(page, name)[c] for name in names) for c in range(3)]
    assert exact(page, "ledger-pixel") == inspected["value"]
    assert total == pytest.approx(np.float32(inspected["value"]).tolist(), rel=1e-14)
    given = [
        (max(e["contribution"]), k, e["step"])
        for k, sample in enumerate(inspected["samples"])
        for e in sample["events"]
        if e["kind"] == "light" and e["depth"] == 1
    ]
    _, path, step = max(given)
    page.get_by_test_id("bar-light-1").click()
    stands_at(page, path, step)


def test_a_factor_leads_to_the_event_that_made_it(page, inspected):
    page.get_by_test_id("tab-equation").click()
    events = inspected["samples"][0]["events"]
    light = next(e for e in events if e["kind"] == "light" and e["depth"] == 1)
    bounce = next(e for e in events if e["kind"] == "bounce" and e["depth"] == 0)
    page.get_by_test_id(f"row-{light['step']}").click()
    page.locator("[data-testid=factor-Le]").wait_for()
    for field in ("beta", "f", "cos", "Le", "w", "pdf"):
        shown = exact(page, f"factor-{field}")
        assert shown == (light[field] if isinstance(light[field], list) else [light[field]])
    page.get_by_test_id("source-beta").click()
    stands_at(page, 0, bounce["step"])
    assert bounce["beta"] == light["beta"]
    page.get_by_test_id(f"row-{light['step']}").click()
    page.get_by_test_id("factor-Le").wait_for()
    page.locator("[data-testid=equation-symbolic] .from").nth(1).click()
    hit = next(e for e in events if e["kind"] == "hit" and e["depth"] == 1)
    stands_at(page, 0, hit["step"])


def test_the_reasons_are_those_of_the_command_and_lead_to_their_events(page, inspected):
    page.get_by_test_id("tab-why").click()
    page.get_by_test_id("why").wait_for()
    reasons = inspected["why"]
    assert page.locator("[data-testid^='reason-']").all_inner_texts() == [r["sentence"] for r in reasons]
    for k, reason in enumerate(reasons):
        page.get_by_test_id(f"reason-{k}").click()
        stands_at(page, reason["path"], reason["event"])
    assert page.get_by_test_id("why-command").inner_text().endswith("--why")


def test_lens_and_microscope_are_those_of_the_command(page, inspected):
    sample = inspected["samples"][0]
    light = next(e for e in sample["events"] if e["kind"] == "light")
    words = ("inspect", "cornell_unit", "--pixel", 30, 45, *SIZE, "--sample", 0, "--json", "--event")
    document = json.loads(castray(*words, light["step"]).stdout)
    page.get_by_test_id(f"row-{light['step']}").click()
    page.get_by_test_id("tab-vertex").click()
    page.get_by_test_id("microscope").wait_for()
    assert exact(page, "microscope") == document["ends"]
    for name, w in document["lens"]["vectors"].items():
        assert exact(page, f"vector-{name}") == w
    tried = exact(page, "lens-tried")
    assert [one for one in tried if one["path"] == 0] == document["lens"]["tried"]
    assert page.get_by_test_id("lens-verdict").inner_text().startswith("✓")
    bounce = next(e for e in sample["events"] if e["kind"] == "bounce")
    page.get_by_test_id(f"row-{bounce['step']}").click()
    page.locator("[data-testid=microscope]").filter(has_not_text="lamp").wait_for()
    assert exact(page, "microscope") == json.loads(castray(*words, bounce["step"]).stdout)["ends"]


def test_a_dot_on_the_disc_leads_to_the_path_that_tried_it(page, inspected):
    light = next(e for e in inspected["samples"][0]["events"] if e["kind"] == "light")
    page.get_by_test_id(f"row-{light['step']}").click()
    page.get_by_test_id("tab-vertex").click()
    page.get_by_test_id("lens").wait_for()
    dot = next(one for one in exact(page, "lens-tried") if one["path"] and one["direction"][2] > 0)
    x, y, z = dot["direction"]
    box = page.get_by_test_id("lens").bounding_box()
    r = min(box["width"] / 2, box["height"] - 18) / 2 - 4
    place = [v / (1 + abs(z)) ** 0.5 * r for v in (x, y)]
    page.mouse.click(box["x"] + box["width"] / 4 + place[0], box["y"] + r + 4 + place[1])
    stands_at(page, dot["path"], dot["event"])


def test_the_hemisphere_comes_and_goes_in_3d_by_the_button_and_by_a_key(page, inspected):
    light = next(e for e in inspected["samples"][0]["events"] if e["kind"] == "light")
    page.get_by_test_id(f"row-{light['step']}").click()
    assert page.get_by_test_id("legend-lobe_f").count() == 0
    page.get_by_test_id("tab-vertex").click()
    page.get_by_test_id("lobes").click()
    page.locator("[data-testid=lobes][aria-pressed=true]").wait_for()
    assert "f |cos|, up to " in page.get_by_test_id("legend-lobe_f").inner_text()
    assert page.get_by_test_id("legend-lobe_p").inner_text() == "p, up to 0.31831 1/sr"
    near = page.evaluate("() => window.trame.state.get('camera').position")
    page.get_by_test_id("tab-event").click()
    page.keyboard.press("h")
    page.get_by_test_id("legend-lobe_f").wait_for(state="detached")
    assert page.evaluate("() => window.trame.state.get('camera').position") != near
