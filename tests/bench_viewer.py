"""How long the viewer takes: to be ready, from an input to what it changed, on the screen; and its memory.

Of a pick and a step that is words and 3D view, of a knob the first picture with the new scene, coarse as yet,
with either engine, of a query the hits. Medians, 95 % points, the slowest of 20 each, go into BENCHMARKS.md.
`python tests/bench_viewer.py [--tiny] [--out FILE]`
"""

import argparse
import itertools
import os
import shutil
import statistics
import sys
import tempfile
import time
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import viewers  # noqa: E402
from bench import PAPER  # noqa: E402
from benchmarks import BENCH, VIEWER  # noqa: E402
from benchmarks.memory import memory_of, slope  # noqa: E402
from benchmarks.paper import page as paper  # noqa: E402
from benchmarks.paper import section_text, sections_of, stamp  # noqa: E402
from benchmarks.section import table  # noqa: E402
from benchmarks.seeing import crowds, on_page, picks, queries, steps, turns  # noqa: E402
from racing import RACE  # noqa: E402
from talking import cookie_of, talk  # noqa: E402

ROUNDS = 20
LIMITS = {
    "server ready": 3000,
    "page ready, after the server": 3000,
    "pick, 3D view drawn": 200,
    "step along the path, drawn": 80,
    "slider to the first refined picture, 128 x 128": 400,
    "the same with --engine gl": 400,
    "4096 paths drawn": 300,
    "query over a million vertices": 500,
}  # milliseconds
ON_A_CARD = {"the same with --engine gl": 100}  # where no processor draws
MEGABYTES = 10.0  # that a thousand picks may leave behind
PICKS = 1000


def starts(rounds, words):
    """One time per start of the server, to its address."""
    for _ in range(rounds):
        began = time.perf_counter()
        server = viewers.Server(*words)
        took = time.perf_counter() - began
        server.stop()
        yield 1e3 * took


def visits(browser, server, rounds):
    """One time per page that is opened, to its being ready."""
    for _ in range(rounds):
        with browser.new_context(viewport={"width": 1500, "height": 900}) as context:
            page = context.new_page()
            began = time.perf_counter()
            page.goto(server.address)
            page.wait_for_selector("html[data-ready]")
            yield 1e3 * (time.perf_counter() - began)


def recorded(folder, side):
    """A recording of the homework's box: over a million vertices at side 160."""
    import tracer

    scene = tracer.load("cornell")
    settings = tracer.Settings(width=side, height=side, spp=16, integrator="direct", roulette="0.8")
    tracer.record(scene, settings, folder, "events")
    return str(folder)


def leak(picks):
    """Megabytes that a thousand picks more leave in the server, and how many it has at the end."""
    server = viewers.Server("cornell_unit", "--size", "32", "32", "--spp", "8")
    try:
        cookie, found = cookie_of(server), []
        places = itertools.cycle([(7 * k % 32, 11 * k % 32) for k in range(997)])
        for _ in range(10):
            calls = [("trame.trigger", ["pick", list(next(places)), {}]) for _ in range(picks // 10)]
            talk(server, cookie, *calls)
            found.append(memory_of(server.process.pid))
        return slope(found[2:]) * 10, found[-1]
    finally:
        server.stop()


def measure(rounds, side=128, crowd=4096, vertices_side=160):
    """{what: [milliseconds]} in the order of LIMITS."""
    from playwright.sync_api import sync_playwright

    chromium = os.environ.get("CHROMIUM") or shutil.which("chromium") or shutil.which("google-chrome")
    words = ("cornell_unit", "--size", str(side), str(side))
    times = [list(starts(rounds, words))]
    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as folder:
        browser = playwright.chromium.launch(executable_path=chromium, args=list(viewers.SWITCHES))
        server = viewers.Server(*words)
        times.append(list(visits(browser, server, rounds)))
        server.stop()
        times += on_page(browser, words, *(partial(work, rounds=rounds) for work in (picks, steps, turns)))
        by_gl = (*words, "--engine", "gl")
        times += on_page(browser, by_gl, partial(turns, rounds=rounds)) if drawn_by() else [[]]
        many = ("cornell_unit", "--size", "8", "8", "--spp", str(crowd))
        times += on_page(browser, many, partial(crowds, rounds=rounds))
        asked = (recorded(Path(folder) / "box", vertices_side),)
        times += on_page(browser, asked, partial(queries, rounds=rounds))
        browser.close()
    return dict(zip(LIMITS, times, strict=True))


def drawn_by():
    """(who draws with OpenGL here, whether that is a graphics card), None if nobody does."""
    from tracer.engine.gl import device

    try:
        return device.renderer(), device.is_hardware()
    except device.TracerError:
        return None


def limits():
    """LIMITS, as they are where a graphics card draws."""
    return LIMITS | (ON_A_CARD if (drawn_by() or ("", False))[1] else {})


def late(values):
    """The 95 % point."""
    return sorted(values)[-1 - len(values) // 20]


def shown(times, memory):
    """The section's text."""
    rows, asked = [], limits()
    for name, values in times.items():
        if not values:
            continue
        rows.append(
            {
                "what": name,
                "median ms": f"{statistics.median(values):.0f}",
                "95 % ms": f"{late(values):.0f}",
                "slowest ms": f"{max(values):.0f}",
                "asked ms": asked[name],
            }
        )
    left, size = memory
    drawn = drawn_by()
    gl = f"gl is drawn by {drawn[0]}." if drawn else "Without OpenGL here, gl was not measured."
    return (
        f"{table(rows)}\n\n{gl} A thousand picks more leave {left:+.1f} MB in the server, which has "
        f"{size:.0f} MB then (asked: less than {MEGABYTES:.0f})."
    )


def main():
    """Write the section; 1 if a 95 % point or the memory is over its limit."""
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("--tiny", action="store_true", help="once each, to see that all works")
    words.add_argument("--out", type=Path, default=PAPER)
    asked = words.parse_args()
    times = measure(1, 16, 64, 16) if asked.tiny else measure(ROUNDS)
    memory = leak(100 if asked.tiny else PICKS)
    texts, found = sections_of(asked.out), shown(times, memory)
    texts[VIEWER.key] = section_text(
        VIEWER, stamp(size="a trial of the machinery" if asked.tiny else ""), found
    )
    asked.out.write_text(paper((*BENCH, VIEWER, RACE), texts), encoding="utf-8")
    print(found)
    most = limits()
    slow = any(values and late(values) > most[name] for name, values in times.items())
    return int(slow or memory[0] > MEGABYTES)


if __name__ == "__main__":
    sys.exit(main())
