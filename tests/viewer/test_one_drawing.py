"""What is done on the page asks the server once and is drawn once, words and 3D view together."""

import pytest

COUNT = """
window.asked = window.pictures = 0;
const { send } = WebSocket.prototype, { clear } = WebGL2RenderingContext.prototype;
WebSocket.prototype.send = function (...said) { window.asked++; return send.apply(this, said); };
WebGL2RenderingContext.prototype.clear = function (...mask) { window.pictures++; return clear.apply(this, mask); };
"""
# Of every layer: what vtk.js has, against what the server said last.
UNLIKE = """
() => {
  const actors = window.trame.refs.view.$.provides.view.renderer.getActors(), state = window.trame.state;
  const same = (a, b) => a.byteLength === b.byteLength && new Uint8Array(a.buffer).every((v, i) => v === b[i]);
  return ["path", "event", "over"].flatMap((level) => state.get(`${level}_strokes`)).filter(([k, points, cells]) => {
    const mesh = actors[k].getMapper().getInputData(), whole = cells.byteLength === 0;
    const lines = mesh.getLines().getData(), faces = mesh.getPolys().getData();
    const [drawn, none] = lines.length ? [lines, faces] : [faces, lines];
    return whole ? actors[k].getVisibility()
      : !(actors[k].getVisibility() && same(mesh.getPoints().getData(), points) && same(drawn, cells) && !none.length);
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
