"""What is done on the page asks the server once and is drawn once, words and 3D view together."""

import pytest

COUNT = """
window.asked = window.pictures = window.frames = 0;
const counted = (prototype, name, count) => {
  const before = prototype[name];
  prototype[name] = function (...given) { count(); return before.apply(this, given); };
};
counted(WebSocket.prototype, "send", () => { window.asked++; });
counted(WebGL2RenderingContext.prototype, "clear", () => { window.pictures++; });
counted(window, "requestAnimationFrame", () => { window.frames++; });
"""
# The layers of which vtk.js has something else than what the server said last.
UNLIKE = """
() => {
  const actors = window.trame.refs.view.$.provides.view.renderer.getActors(), state = window.trame.state;
  const bytes = (values) => new Uint8Array(values.buffer).join(), said = (given) => [...given].join();
  const strokes = ["path", "event", "over"].flatMap((level) => state.get(`${level}_strokes`));
  return strokes.filter(([k, points, cells]) => {
    const actor = actors[k], mesh = actor.getMapper().getInputData();
    if (!cells.byteLength) return actor.getVisibility();
    const [lines, faces] = [mesh.getLines().getData(), mesh.getPolys().getData()];
    const [drawn, none] = lines.length ? [lines, faces] : [faces, lines];
    const same = bytes(mesh.getPoints().getData()) === said(points) && bytes(drawn) === said(cells);
    return !(actor.getVisibility() && same && !none.length);
  }).map(([k]) => k);
}
"""


def settled(page):
    """Wait until the 3D view has not been drawn for a while; how often it has been drawn."""
    drawn, before = page.evaluate("() => window.pictures"), None
    while drawn != before:
        page.wait_for_timeout(500)
        drawn, before = page.evaluate("() => window.pictures"), drawn
    return drawn


@pytest.fixture(scope="module")
def page(browser, small):
    with browser.new_context(viewport={"width": 1280, "height": 720}) as context:
        page = context.new_page()
        page.set_default_timeout(120_000)  # milliseconds, as of the other tests of the page
        page.add_init_script(COUNT)
        page.goto(small.address)
        page.wait_for_selector("html[data-ready]")
        page.wait_for_selector("[data-testid=progress]", state="detached")
        page.evaluate("() => window.trame.trigger('pick', [30, 50])")
        page.wait_for_function("() => window.location.hash.includes('x=30&y=50')")
        page.keyboard.press("Home")
        page.wait_for_function("() => window.location.hash.includes('event=0')")
        settled(page)
        yield page


@pytest.mark.browser
@pytest.mark.parametrize("key", ["ArrowRight", "ArrowDown", "Shift+ArrowLeft"])
def test_a_step_another_path_and_another_pixel_ask_once_and_are_drawn_once(page, key):
    page.evaluate("() => { window.asked = window.pictures = 0; window.before = window.location.hash; }")
    page.keyboard.press(key)
    page.wait_for_function("() => window.location.hash !== window.before")
    assert settled(page) == 1
    assert page.evaluate("() => window.asked") == 1
    assert page.evaluate(UNLIKE) == []


@pytest.mark.browser
def test_the_3d_view_shows_what_the_server_says_also_after_the_scene_came_anew(page):
    page.evaluate("() => window.trame.trigger('event', [1])")
    page.get_by_test_id("tab-change").click()
    knob = page.locator("input[type=range][data-testid^=change-]").first
    knob.fill(knob.get_attribute("max"))
    page.wait_for_function("() => window.location.hash.includes('set=')")
    page.wait_for_selector("[data-testid=progress]", state="detached")
    settled(page)
    assert page.evaluate(UNLIKE) == []
    page.evaluate("() => window.trame.trigger('lobes')")
    page.wait_for_selector("[data-testid=legend-lobe_f]")
    settled(page)
    assert page.evaluate(UNLIKE) == []


@pytest.mark.browser
def test_a_page_in_which_nothing_happens_asks_for_no_frames(page):
    settled(page)
    page.evaluate("() => { window.frames = 0; }")
    page.wait_for_timeout(500)
    assert page.evaluate("() => window.frames") == 0
    page.get_by_test_id("home").click()
    page.wait_for_function("() => window.frames > 0")


# A walk to the next path; the address as soon as the page shows it, and after the reader has left the page.
LEFT = """
() => new Promise((told) => {
  const seen = new MutationObserver(() => {
    seen.disconnect();
    const before = window.location.hash.slice(1);
    window.dispatchEvent(new Event("blur"));
    told([before, window.location.hash.slice(1), window.trame.state.get("link")]);
  });
  seen.observe(document.querySelector("[data-link]"), { attributeFilter: ["data-link"] });
  window.trame.trigger("go", ["down"]);
})
"""


@pytest.mark.browser
def test_the_address_waits_until_the_reader_rests_or_leaves_the_page(page):
    page.wait_for_function("() => window.location.hash.slice(1) === window.trame.state.get('link')")
    before, after, link = page.evaluate(LEFT)
    assert before != link and after == link
