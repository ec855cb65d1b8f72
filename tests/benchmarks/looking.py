"""What looking costs: events taken and dropped, paths kept, a pixel picked, a step along its path."""

import tempfile
from collections import deque
from pathlib import Path

import numpy as np

import tracer
from benchmarks import scenes
from benchmarks.section import in_turn, settings, short, table
from tracer import film, trace
from tracer.engine import waves
from tracer.integrator.steps import RIGHT
from tracer.integrator.wave import Wave
from tracer.trace.recording import bytes_of_path
from viewer.session import Session
from viewer.words import Speaker

KERNEL_EVERY = 10  # rounds


def rendered(scene, asked, look):
    """A picture's mean, each wave's events going through look(events)."""
    sheet = film.Film(asked.width * asked.height)
    for task in waves.tasks(asked):
        pixel = np.repeat(task.numbers, task.samples)
        sample = np.tile(np.arange(task.sample, task.sample + task.samples), task.numbers.size)
        wave = Wave(pixel % asked.width, pixel // asked.width, sample, asked, RIGHT)
        look(waves.events(scene, asked, wave))
        sheet.add(task.pixels, film.block(wave.radiance.reshape(3, -1, task.samples)))
    return sheet.mean()


def _dropped(events):
    """Every event's carried columns are taken, as a recorder would, and dropped."""
    for event in events:
        dict(event.columns)


def _recorded(scene, asked, level):
    """A picture recorded into a new folder; the bytes of its parts."""
    with tempfile.TemporaryDirectory() as folder:
        tracer.record(scene, asked, Path(folder) / "recording", level)
        return sum(file.stat().st_size for file in Path(folder).rglob("*.parquet"))


ASKED = {"events taken and dropped": "1.30", "paths recorded": "1.15"}


def recorder(size, say):
    """A plain render against the same with every event taken and dropped, and with paths and events kept."""
    asked = settings(size).at_size_of(scenes.box())
    scene = scenes.box().at(asked)
    works = {
        "render": lambda: tracer.render(scene, asked).rgb,
        "events not looked at": lambda: rendered(scene, asked, lambda events: deque(events, maxlen=0)),
        "events taken and dropped": lambda: rendered(scene, asked, _dropped),
        "paths recorded": lambda: _recorded(scene, asked, "paths"),
        "events recorded": lambda: _recorded(scene, asked, "events"),
    }
    times = in_turn(works, 3 * size.repeats, say)
    plain = times["render"].median
    shown = table(
        [
            {
                "what": name,
                "seconds": short(t.median),
                "kernel ms": t.kernel,
                "of the render": f"{t.median / plain:.2f}",
                "asked": ASKED.get(name, ""),
            }
            for name, t in times.items()
        ]
    )
    return f"{shown}\n\n{_disk(scene, asked, times['events recorded'].median - plain)}"


def _disk(scene, asked, seconds):
    """What recording every event takes on disk, and how fast it goes there, in words."""
    paths = asked.width * asked.height * asked.spp
    vertices = sum(part.vertices for part in trace.parts(scene, asked))
    on_disk = _recorded(scene, asked, "events")
    held = paths * bytes_of_path(scene, asked)
    return (
        f"Every event recorded: {vertices:,} vertices, {short(on_disk / vertices)} bytes each on disk (at "
        f"most 250), {short(held / vertices)} as columns in memory, which go to the disk at "
        f"{short(held / 1e6 / seconds)} MB/s beside the rendering (asked: 200)."
    )


def pick(size, say):
    """Picks at 16 spp, of pixels spread over the picture, and steps along the path picked last."""
    asked, mesh = settings(size, spp=16), scenes.ball(size.brute)
    found = {
        "cornell_unit": (scenes.box(), "30 ms"),
        f"{mesh.primitives:,} triangles": (scenes.box_with(mesh), "200 ms"),
    }
    rows = []
    for name, (scene, bar) in found.items():
        sized = asked.at_size_of(scene)
        places, calls = _places(sized), _server(Session(scene, sized, tracer.load))
        works = {
            "pick: the pixel traced again": lambda scene=scene, sized=sized, places=places: tracer.inspect(
                scene, sized, *next(places)
            ),
            "pick: all the server does": lambda calls=calls, places=places: calls["pick"](*next(places)),
        }
        times = in_turn(works, size.picks, say, KERNEL_EVERY)
        times |= in_turn({"step: all the server does": _stepper(calls)}, size.steps, say, KERNEL_EVERY)
        bars = (bar, bar, "5 ms")
        rows += [
            _row(name, *what_and_times, bar) for what_and_times, bar in zip(times.items(), bars, strict=True)
        ]
    return table(rows)


def _places(asked):
    """Pixels spread over the picture, without end."""
    k = 0
    while True:
        k += 1
        yield int(k * 0.754877666 % 1.0 * asked.width), int(k * 0.569840291 % 1.0 * asked.height)


def _server(session):
    """The calls of a page, answered by a server that sends nothing."""
    from trame.app import get_server

    from viewer.calls import Calls
    from viewer.window import Window

    session.pick(session.settings.width // 2, session.settings.height // 2)
    server = get_server(f"bench-{id(session)}", client_type="vue3")
    return Calls(Window(server, session, Speaker("en"))).by_name | {"session": session}


def _stepper(calls):
    """A step along the path and, from its end, back."""
    session, ahead = calls["session"], True

    def step():
        nonlocal ahead
        cursor = session.cursor
        ahead = cursor.event == 0 or (ahead and not cursor.at_end)
        calls["go"]("next" if ahead else "previous")

    return step


def _row(scene, what, times, bar):
    return {
        "scene": scene,
        "what": what,
        "ms": short(1e3 * times.median),
        "slowest": short(1e3 * max(times.seconds)),
        "kernel ms": times.kernel,
        "asked": bar,
    }
