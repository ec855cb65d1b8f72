"""The page takes care of servers that end and come back, of keys without a mouse, of those who cannot see."""

import re

import pytest
from suite import ROOT
from viewers import SMALL

from viewer.panels.help import KEYS
from viewer.words import LANGUAGES, table

SCRIPT = (ROOT / "viewer" / "static" / "castray.js").read_text(encoding="utf-8")


SEEN = """[...document.querySelectorAll("button,input,select,textarea,summary,a[href]")]
  .filter((e) => e.offsetParent !== null)"""
TOLD = ".map((e) => e.outerHTML.slice(0, 120))"
NAMELESS = f"""() => {SEEN}.filter((e) => !(e.getAttribute("aria-label") || e.title || e.textContent.trim()
  || [...(e.labels || [])].some((l) => l.textContent.trim() || l.getAttribute("aria-label")))){TOLD}"""
SKIPPED = f"() => {SEEN}.filter((e) => e.tabIndex !== 0){TOLD}"


def test_the_help_lists_every_key_that_the_page_hears():
    heard = set()
    for name in ("KEYS", "TABS", "CALLS"):
        body = re.search(rf"const {name} = {{(.*?)}};", SCRIPT)[1]
        heard |= set(re.findall(r'(?:^|, )\s*"?([^\s":,\[\]]+|\[|\])"?: ', body))
    signs = {"ArrowLeft": "←", "ArrowRight": "→", "ArrowUp": "↑", "ArrowDown": "↓"}
    for language in LANGUAGES:
        listed = " ".join(table(language)[f"key.{k}"] for k in KEYS).lower()
        missing = {key for key in heard if signs.get(key, key).lower() not in listed}
        assert missing == set()
    assert heard >= {"ArrowLeft", "Home", "?", "l", "[", "]", "n", "p"}


@pytest.mark.browser
def test_after_the_server_was_started_again_the_page_goes_on_where_it_was(serve, visit):
    server = serve("cornell_unit", *SMALL)
    page = visit(server.address)
    page.evaluate("() => window.trame.trigger('pick', [9, 21])")
    page.wait_for_selector("[data-testid=event-table][data-pixel='9,21']")
    page.wait_for_function("() => window.location.hash.includes('x=9&y=21')")
    server.stop()
    lost = page.get_by_test_id("lost")
    lost.wait_for(timeout=20_000)
    assert f"--port {server.port}" in lost.inner_text() and "castray view" in lost.inner_text()
    again = serve("cornell_unit", *SMALL, "--port", str(server.port))
    assert again.key != server.key  # without the new one the page gets nothing
    page.wait_for_timeout(2000)
    assert lost.count() == 1
    visit(again.address)
    lost.wait_for(state="detached", timeout=20_000)
    page.wait_for_selector("[data-testid=event-table][data-pixel='9,21']", timeout=20_000)


@pytest.mark.browser
def test_everything_that_can_be_used_has_a_name_and_is_reached_by_keys(small, visit):
    page = visit(small.address)
    page.get_by_test_id("open").locator("summary").click()
    tabs = page.locator("[role=tab]").evaluate_all("all => all.map(e => e.dataset.testid)")
    for tab in tabs:
        page.get_by_test_id(tab).click(force=True)
        page.wait_for_timeout(150)
        assert page.evaluate(NAMELESS) == [], tab
        assert page.evaluate(SKIPPED) == [], tab  # the order of focus is that of the page
    assert page.errors == []
