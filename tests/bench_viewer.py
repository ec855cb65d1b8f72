"""How long a pick, a step and a turned knob take in the browser: from the input to what it changed, drawn.

Of a pick and a step that is the 3D view, of a knob the first picture with the new scene, coarse as yet.
Prints medians, 95 % points and the slowest of 20 each.
`python tests/bench_viewer.py [SCENE] [castray view options]`
"""

import statistics
import sys
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import viewers  # noqa: E402

ROUNDS = 20
LIMITS = {"pick": 250, "step": 100, "turn": 400}

# In the page: how often the 3D canvas was drawn, what it shows as one number, where the reader stands.
COUNT = """
window.pictures = 0;
const clear = WebGL2RenderingContext.prototype.clear;
WebGL2RenderingContext.prototype.clear = function (...mask) {
  window.pictures++;
  return clear.apply(this, mask);
};
"""
WATCH = """
() => {
  const small = Object.assign(document.createElement("canvas"), {width: 160, height: 120});
  const g = small.getContext("2d", {willReadFrequently: true});
  window.drawn = () => {
    g.clearRect(0, 0, 160, 120);
    g.drawImage(document.querySelector(".stage canvas"), 0, 0, 160, 120);
    const d = g.getImageData(0, 0, 160, 120).data;
    let sum = 0;
    for (let i = 0; i < d.length; i++) sum = (sum * 31 + d[i]) | 0;
    return sum;
  };
  window.where = () => {
    const table = document.querySelector("[data-testid=event-table]");
    const now = table.querySelector("[data-now=true]");
    return [table.dataset.pixel, table.dataset.path, now && now.dataset.testid].join(" ");
  };
  const begin = () => { window.began = performance.now(); };
  for (const kind of ["pointerdown", "keydown"]) window.addEventListener(kind, begin, true);
}
"""
# The time from the last input until both have changed; 0 where that does not happen (nothing new in sight).
ARM = """
() => {
  const picture = window.drawn(), place = window.where(), end = performance.now() + 5000;
  let seen = window.pictures; // reading the canvas back is dear: only when it has been drawn again
  window.took = new Promise((resolve) => {
    const look = () => {
      const again = window.pictures !== seen && window.where() !== place;
      if (again) seen = window.pictures;
      if (again && window.drawn() !== picture) resolve(performance.now() - window.began);
      else if (performance.now() > end) resolve(0);
      else requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
  });
}
"""


def timed(page, act):
    """Milliseconds from an input to what it changed, drawn."""
    page.evaluate(ARM)
    act()
    took = page.evaluate("() => window.took")
    page.wait_for_timeout(100)
    return took


def picks(page):
    """One time per pick, at pixels spread over the picture."""
    box = page.locator("[data-testid=picture]").bounding_box()
    for k in range(ROUNDS):
        x = box["x"] + box["width"] * (0.15 + 0.7 * (k * 7 % ROUNDS) / ROUNDS)
        y = box["y"] + box["height"] * (0.25 + 0.6 * (k * 3 % ROUNDS) / ROUNDS)
        page.mouse.move(x, y)
        yield timed(page, partial(page.mouse.click, x, y))


def steps(page):
    """One time per step along the path, and back."""
    page.keyboard.press("Home")
    page.wait_for_timeout(300)
    last = int(page.locator("[data-testid=event-table] tbody tr").count()) - 1
    forward, at = True, 0
    for _ in range(ROUNDS):
        forward = at == 0 or (forward and at < last)
        at += 1 if forward else -1
        yield timed(page, partial(page.keyboard.press, "ArrowRight" if forward else "ArrowLeft"))


# The time from a knob's move until the first picture with the new scene has come and was drawn.
TURN = """
([key, value]) => new Promise((resolve) => {
  const knob = document.querySelector(`[data-testid="${key}"]`), before = window.trame.state.get("rgb");
  const began = performance.now();
  knob.value = value;
  knob.dispatchEvent(new Event("input"));
  const look = () => {
    const came = window.trame.state.get("rgb") !== before;
    if (came) requestAnimationFrame(() => resolve(performance.now() - began));
    else requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
})
"""


def turns(page):
    """One time per move of the first knob of the scene; the finer pictures of each are waited for."""
    page.get_by_test_id("tab-change").click()
    knob = page.locator("input[type=range][data-testid^=change-]").first.get_attribute("data-testid")
    for k in range(ROUNDS):
        yield page.evaluate(TURN, [knob, 0.2 + 0.6 * (k * 7 % ROUNDS) / ROUNDS])
        page.wait_for_selector("[data-testid=progress]", state="detached", timeout=120_000)


def measure(chromium, words):
    """{"pick": [...], "step": [...], "turn": [...]} in milliseconds."""
    from playwright.sync_api import sync_playwright

    server = viewers.Server(*words)
    try:
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(executable_path=chromium, args=list(viewers.SWITCHES))
            page = browser.new_page(viewport={"width": 1500, "height": 900})
            page.add_init_script(COUNT)
            page.goto(server.address)
            page.wait_for_selector("html[data-ready]")
            page.wait_for_selector("[data-testid=progress]", state="detached", timeout=120_000)
            page.evaluate(WATCH)
            page.wait_for_timeout(500)
            times = {"pick": list(picks(page)), "step": list(steps(page)), "turn": list(turns(page))}
            browser.close()
    finally:
        server.stop()
    return times


def main():
    """Print the figures; 1 if a median is over its limit."""
    import shutil

    chromium = shutil.which("chromium") or shutil.which("google-chrome")
    times = measure(chromium, sys.argv[1:] or ["cornell_unit"])
    for name, values in times.items():
        middle, most = statistics.median(values), sorted(values)[-1 - len(values) // 20]
        said = f"median {middle:.0f} ms, 95 % {most:.0f} ms, slowest {max(values):.0f} ms"
        print(f"{name}: {said}, limit {LIMITS[name]} ms")
    return int(any(statistics.median(v) > LIMITS[k] for k, v in times.items()))


if __name__ == "__main__":
    sys.exit(main())
