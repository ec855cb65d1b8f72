"""From an input to the frame on the screen that shows what came of it, in a page of the viewer."""

from functools import partial

import viewers

# Counts how often a canvas of WebGL was drawn.
COUNT = """
window.pictures = 0;
const clear = WebGL2RenderingContext.prototype.clear;
WebGL2RenderingContext.prototype.clear = function (...mask) {
  window.pictures++;
  return clear.apply(this, mask);
};
"""
# Puts a mark into each frame in which the 3D view has been drawn or the reader stands elsewhere. Chromium
# tells when a mark was on the screen: composed and drawn, with all that its frame has besides.
WATCH = """
() => {
  const waiting = new Map();
  const where = () => {
    const table = document.querySelector("[data-testid=event-table]");
    const now = table.querySelector("[data-now=true]");
    return [table.dataset.pixel, table.dataset.path, now && now.dataset.testid].join(" ");
  };
  let number = 0;
  window.onScreen = () => new Promise((resolve) => {
    const mark = document.createElement("p");
    mark.setAttribute("elementtiming", mark.textContent = `mark ${number++}`);
    mark.style.cssText = "position: fixed; left: 0; top: 0; font-size: 8px; will-change: transform";
    waiting.set(mark.textContent, (time) => { mark.remove(); resolve(time); });
    document.body.append(mark);
  });
  new PerformanceObserver((list) => {
    for (const { identifier, renderTime } of list.getEntries()) waiting.get(identifier)?.(renderTime);
  }).observe({type: "element"});
  let seen = window.pictures, place = where();
  window.changes = [];
  const look = () => {
    requestAnimationFrame(look);
    if (window.pictures === seen && where() === place) return;
    [seen, place] = [window.pictures, where()];
    window.changes.push([performance.now(), window.onScreen()]);
  };
  requestAnimationFrame(look);
  const begin = (event) => { window.began = event.timeStamp; window.changes = []; };
  for (const kind of ["pointerdown", "keydown"]) window.addEventListener(kind, begin, true);
}
"""
# The time from the last input until its last frame was on the screen; none follows for a while.
LAST = """
(quiet) => new Promise((resolve, reject) => {
  const end = performance.now() + 10000;
  const wait = setInterval(() => {
    const last = window.changes.at(-1);
    if (!last && performance.now() > end) reject(new Error("nothing was seen to change"));
    if (!last || performance.now() - last[0] < quiet) return;
    clearInterval(wait);
    last[1].then((time) => resolve(time - window.began));
  }, 25);
})
"""
QUIET = 400  # milliseconds


def timed(page, act):
    """Milliseconds from an input to the last frame that was drawn because of it."""
    act()
    return page.evaluate(LAST, QUIET)


def picks(page, rounds):
    """One time per pick, at pixels spread over the picture."""
    box = page.locator("[data-testid=picture]").bounding_box()
    for k in range(rounds):
        x = box["x"] + box["width"] * (0.15 + 0.7 * (k * 7 % 20) / 20)
        y = box["y"] + box["height"] * (0.25 + 0.6 * (k * 3 % 20) / 20)
        page.mouse.move(x, y)
        yield timed(page, partial(page.mouse.click, x, y))


def steps(page, rounds):
    """One time per step along the path, and back."""
    page.keyboard.press("Home")
    page.wait_for_timeout(600)
    last = int(page.locator("[data-testid=event-table] tbody tr").count()) - 1
    forward, at = True, 0
    for _ in range(rounds):
        forward = at == 0 or (forward and at < last)
        at += 1 if forward else -1
        yield timed(page, partial(page.keyboard.press, "ArrowRight" if forward else "ArrowLeft"))


# The time from a knob's move until the first picture with the new scene is on the screen.
TURN = """
([key, value]) => new Promise((resolve) => {
  const knob = document.querySelector(`[data-testid="${key}"]`), before = window.trame.state.get("rgb");
  const began = performance.now();
  knob.value = value;
  knob.dispatchEvent(new Event("input"));
  const look = () => {
    const came = window.trame.state.get("rgb") !== before;
    if (came) window.onScreen().then((time) => resolve(time - began));
    else requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
})
"""


def turns(page, rounds):
    """One time per move of the first knob of the scene; the finer pictures of each are waited for."""
    page.get_by_test_id("tab-change").click()
    knob = page.locator("input[type=range][data-testid^=change-]").first.get_attribute("data-testid")
    for k in range(rounds):
        yield page.evaluate(TURN, [knob, 0.2 + 0.6 * (k * 7 % 20) / 20])
        page.wait_for_selector("[data-testid=progress]", state="detached", timeout=120_000)


# The time from a query's Enter until its own hits are on the screen.
ASK = """
(text) => new Promise((resolve) => {
  const began = performance.now();
  window.trame.trigger("find", [text]);
  const look = () => {
    const find = window.trame.state.get("find");
    const came = find && find.text === text && !find.busy && (find.found || find.error);
    if (came) window.onScreen().then((time) => resolve(time - began));
    else requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
})
"""


def queries(page, rounds):
    """One time per query, no two alike."""
    page.get_by_test_id("tab-find").click()
    page.evaluate(ASK, "depth > 3")  # the first opens the recording
    for k in range(rounds):
        yield page.evaluate(ASK, f"depth >= 2 AND pdf < 0.0{k + 1}")


def crowds(page, rounds):
    """One time per turn to the next of very many paths, all drawn anew."""
    for _ in range(rounds):
        yield timed(page, partial(page.keyboard.press, "ArrowDown"))


def on_page(browser, words, *works):
    """What each of works(page) gives, of a viewer and a page that are ready and idle."""
    server = viewers.Server(*words)
    try:
        with browser.new_context(viewport={"width": 1500, "height": 900}) as context:
            page = context.new_page()
            page.add_init_script(COUNT)
            page.goto(server.address)
            page.wait_for_selector("html[data-ready]")
            page.wait_for_selector("[data-testid=progress]", state="detached", timeout=120_000)
            page.evaluate(WATCH)
            page.wait_for_timeout(500)
            return [list(work(page)) for work in works]
    finally:
        server.stop()
