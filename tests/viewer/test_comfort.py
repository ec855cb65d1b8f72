"""The page takes care of servers that end and come back, of keys without a mouse, of those who cannot see."""

import re
from unittest.mock import MagicMock

import pytest
from suite import ROOT
from viewers import SMALL

from viewer.calls import OWN
from viewer.panels import all_panels
from viewer.panels.help import KEYS
from viewer.words import LANGUAGES, table

SCRIPT = (ROOT / "viewer" / "static" / "tab.js").read_text(encoding="utf-8")


SEEN = """[...document.querySelectorAll("button,input,select,textarea,summary,a[href]")]
  .filter((e) => e.offsetParent !== null)"""
TOLD = ".map((e) => e.outerHTML.slice(0, 120))"
NAMELESS = f"""() => {SEEN}.filter((e) => !(e.getAttribute("aria-label") || e.title || e.textContent.trim()
  || [...(e.labels || [])].some((l) => l.textContent.trim() || l.getAttribute("aria-label")))){TOLD}"""
SKIPPED = f"() => {SEEN}.filter((e) => e.tabIndex !== 0){TOLD}"


def test_the_page_hears_the_keys_that_its_help_lists_and_no_others():
    asked = {call[0] for group in KEYS.values() for call in group.values()}
    known = {*OWN, *(name for panel in all_panels() if panel.calls for name in panel.calls(MagicMock()))}
    assert asked - known == {"beside", "help"}  # which the page does itself
    keys = [key for group in KEYS.values() for key in group]
    assert len(keys) == len(set(keys)) and {"ArrowLeft", "Home", "?", "l", "[", "]", "n", "p"} <= set(keys)
    signs = {"ArrowLeft": "←", "ArrowRight": "→", "ArrowUp": "↑", "ArrowDown": "↓"}
    for language in LANGUAGES:
        for name, group in KEYS.items():
            listed = table(language)[f"key.{name}"].lower()
            for key in group:
                assert name in ("space", "shift") or signs.get(key, key).lower() in listed
    heard = re.findall(r"event\.key === \"([^\"]*)\"", SCRIPT)
    assert heard == [" "]  # Space on a button is the button's own


@pytest.mark.browser
def test_the_help_is_a_dialog_that_keeps_the_focus_and_gives_it_back(small, visit):
    page = visit(small.address)
    dialog, row = page.get_by_role("dialog", name="Help"), page.locator("tr.now")
    page.get_by_test_id("mark-0").click()
    page.locator("[data-testid=row-0][data-now=true]").wait_for()
    page.keyboard.press("?")
    dialog.wait_for()
    assert dialog.locator(".keys tr").count() == len(KEYS)
    within = "() => document.activeElement.closest('dialog') !== null"
    for key in ("Tab", "Tab", "Tab", "Shift+Tab", "Shift+Tab"):
        page.keyboard.press(key)
        assert page.evaluate(within)
    page.keyboard.press("ArrowRight")  # of the dialog now, not of the path
    page.keyboard.press("Escape")
    dialog.wait_for(state="hidden")
    assert page.evaluate("() => document.activeElement.dataset.testid") == "mark-0"
    assert row.first.get_attribute("data-testid") == "row-0"
    page.get_by_test_id("help-open").click()
    dialog.wait_for()
    page.keyboard.press("?")
    dialog.wait_for(state="hidden")
    page.keyboard.press("ArrowRight")
    page.locator("[data-testid=row-1][data-now=true]").wait_for()
    assert page.errors == []


@pytest.mark.browser
def test_after_the_server_was_started_again_the_page_goes_on_where_it_was(serve, visit):
    server = serve("cornell_unit", *SMALL)
    page = visit(server.address)
    page.evaluate("() => window.trame.trigger('pick', [9, 21])")
    page.wait_for_selector("[data-testid=event-table][data-pixel='9,21']")
    page.wait_for_function("() => window.location.hash.includes('x=9&y=21')")
    server.stop()
    lost = page.get_by_test_id("lost")
    lost.wait_for()
    assert f"--port {server.port}" in lost.inner_text() and "castray view" in lost.inner_text()
    again = serve("cornell_unit", *SMALL, "--port", str(server.port))
    assert again.key != server.key  # without the new one the page gets nothing
    page.wait_for_timeout(2000)
    assert lost.count() == 1
    visit(again.address)
    lost.wait_for(state="detached")
    page.wait_for_selector("[data-testid=event-table][data-pixel='9,21']")


@pytest.mark.browser
def test_everything_that_can_be_used_has_a_name_and_is_reached_by_keys(small, visit):
    page = visit(small.address)
    page.get_by_test_id("open").locator("summary").click()
    tree = page.context.new_cdp_session(page)
    tabs = page.locator("[role=tab]").evaluate_all("all => all.map(e => e.dataset.testid)")
    for language in LANGUAGES:
        page.get_by_test_id("language").select_option(language)
        page.wait_for_function("tag => document.documentElement.lang === tag", arg=language)
        for tab in tabs:
            page.get_by_test_id(tab).click(force=True)
            page.wait_for_timeout(150)
            assert page.evaluate(NAMELESS) == [], tab
            assert page.evaluate(SKIPPED) == [], tab  # the order of focus is that of the page
            heard = told(tree)
            assert [role for role, name, used in heard if used and not name.strip()] == [], (tab, language)
            named = ("tab", "image", "search", "tablist", "region")
            names = [name for role, name, _ in heard if role in named]
            assert all(bool(CHINESE.search(name)) == (language == "zh") for name in names), (tab, names)
    assert page.errors == []


USED = {"button", "link", "searchbox", "textbox", "slider", "combobox", "spinbutton", "tab", "checkbox",
        "radio", "image", "search", "tabpanel", "toolbar", "dialog", "alertdialog",
        "DisclosureTriangle"}  # fmt: skip
CHINESE = re.compile(r"[\u4e00-\u9fff]")


def told(tree):
    """What a screen reader is told, [(role, name, whether it can be used or has to have a name)]."""
    nodes = [node for node in tree.send("Accessibility.getFullAXTree")["nodes"] if not node.get("ignored")]
    return [
        (
            node["role"]["value"],
            node.get("name", {}).get("value", ""),
            node["role"]["value"] in USED
            or node["role"]["value"] != "RootWebArea"
            and any(p["name"] == "focusable" and p["value"]["value"] for p in node.get("properties", [])),
        )
        for node in nodes
    ]


@pytest.mark.browser
def test_a_control_without_a_name_would_be_seen(small, visit):
    """The test above can fail."""
    page = visit(small.address)
    page.evaluate(
        "document.querySelector('[data-testid=zoom-in]').replaceWith(document.createElement('button'))"
    )
    tree = page.context.new_cdp_session(page)
    assert [role for role, name, used in told(tree) if used and not name.strip()] == ["button"]
