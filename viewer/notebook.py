"""The viewer in a notebook: `viewer.show("cornell_unit", bug="D01")` at the end of a cell.

What a cell displays is first a page that needs nothing else: the picture, and one pixel's paths in 3D. Where
the notebook is open in a browser on this machine, the viewer itself takes its place, served by a process that
ends with the notebook's. IPython is not needed for any of it: notebooks ask an object how to show itself.
"""

import os
import pickle
import subprocess
import sys
import tempfile
from html import escape
from pathlib import Path

import numpy as np

import tracer
from lessons.zoo import planted
from tracer.picture import write_whole
from tracer.scene import Scene
from tracer.settings import TracerError
from tracer.trace import folder
from tracer.trace.stored_scene import restore
from tracer.trace.trace import Trace
from viewer.cursor import Cursor
from viewer.offline.page import page
from viewer.recorded import is_recording
from viewer.render import preview
from viewer.session import brightest, most_giving, telling_pixel
from viewer.words import Speaker

ROOT = Path(__file__).resolve().parent.parent
FRAME = 720  # pixels that a cell is high
RUNNING: list = []  # servers that were not closed: a cell may show what no name holds
CHILD = "from viewer.notebook import child; child()"
SWAP = """<script>(() => {
  const frame = document.currentScript.previousElementSibling, host = window.location.hostname;
  if (!["localhost", "127.0.0.1"].includes(host)) return;
  const at = (path) => `http://${host}:%(port)d${path}?key=%(key)s`;
  fetch(at("/alive"), { mode: "no-cors" }).then(() => {
    const live = document.createElement("iframe");
    live.style.cssText = frame.style.cssText; live.src = at("/");
    frame.replaceWith(live);
  }, () => {});
})();</script>"""


def show(what="cornell_unit", settings=None, *, pixel=None, compare=None, live=True, frame=FRAME, **options):
    """Show a scene, or a trace of castray's, in a notebook. What it returns displays itself there; elsewhere
    it says where to open the viewer.

    what: the name or file of a scene, a Scene, a recording's folder, or a Trace; settings: Settings, or their
    options by name, such as spp=16, bug="D01"; pixel: (x, y) to open at; compare: what the picture is
    compared with, as of castray view --compare; live: whether the viewer is started, else only the page that
    needs nothing else is made; frame: height in pixels. Raises TracerError.
    """
    scene, settings, recording = _asked(what, settings, options)
    settings = settings.at_size_of(scene)
    x, y = telling_pixel(scene, settings) if pixel is None else _place(pixel)
    record = tracer.inspect(scene, settings, x, y, steps=planted(settings))
    path = brightest(record)
    lengths = tuple(len(one.events) for one in record.paths)
    cursor = Cursor(x, y, lengths, path, most_giving(record.paths[path]))
    html = page(scene, record, cursor, Speaker(), preview(scene, settings))
    place = (x, y, path, cursor.event)
    return Shown(html, _Server(scene, settings, place, recording, compare) if live else None, frame)


def _place(pixel):
    """The column and row that were asked for."""
    if np.shape(pixel) != (2,):
        raise TracerError(f"pixel: {pixel!r:.40} is not (x, y)")
    return pixel


def _asked(what, settings, options):
    """Scene, settings and, of a recording, its folder."""
    if settings is not None and options:
        raise TracerError(f"show: give settings, or {', '.join(options)}, not both")
    if isinstance(what, (str, Path)) and str(what).lower().endswith((".py", ".jsonl")):
        raise TracerError(f"show: {what} is another tracer's; castray view {what} --scene SCENE opens it")
    if isinstance(what, (str, Path)) and not is_recording(str(what)):
        what = tracer.load(what)
    if not isinstance(what, (str, Path, Trace, Scene)):
        raise TracerError(f"show: {what!r:.40} is no scene, no file of one, no recording and no trace")
    if not isinstance(what, (str, Path, Trace)):
        return what, settings or tracer.Settings(**options), None
    if settings is not None or options:
        raise TracerError("show: a trace has its own settings; leave out what else is asked for")
    if isinstance(what, Trace):
        if what.rebuilt or what.eps != np.finfo(what.scene.dtype).eps:
            raise TracerError("show: the paths of a log cannot be traced again; show the scene that it is of")
        return what.scene, what.settings, None
    place = folder.whole(what)
    return restore(place.path, place.header["scene"]["name"]), place.settings, place


class Shown:
    """What `show` returns. html: the page that needs nothing else."""

    def __init__(self, html, server, frame):
        self.html, self._server, self._frame = html, server, frame

    @property
    def address(self):
        """Where the viewer is, with its key; None without one."""
        return self._server and self._server.address

    def save(self, file):
        """Write the page that needs nothing else."""
        write_whole(file, lambda beside: Path(beside).write_text(self.html, encoding="utf-8"))

    def close(self):
        """End the viewer; the page stays."""
        if self._server:
            self._server.close()

    def _repr_html_(self):
        look = f"width:100%;height:{self._frame}px;border:0;border-radius:8px"
        frame = f'<iframe sandbox="allow-scripts" style="{look}" srcdoc="{escape(self.html)}"></iframe>'
        return frame + (SWAP % self._server.door if self._server else "")

    def __repr__(self):
        if self.address is None:
            return "castray: a page for a notebook; .save(FILE) writes it, to be opened in a browser"
        return f"castray: open {self.address} in a browser; in a notebook it shows itself; .close() ends it"


class _Server:
    """A viewer in a process of its own. It ends with this one."""

    def __init__(self, scene, settings, place, recording, compare):
        there = os.environ.get("PYTHONPATH")
        more = {
            "PYTHONPATH": os.pathsep.join([str(ROOT), *([there] if there else [])]),
            "PYTHONSAFEPATH": "1",  # a file beside the notebook may well be called tracer.py
            "PYTHONIOENCODING": "utf-8",
        }
        errors = tempfile.TemporaryFile()  # not a pipe, which would be full some day
        self._process = subprocess.Popen(
            [sys.executable, "-c", CHILD],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=errors,
            env={**os.environ, **more},
        )
        asked = {"start": place, "recording": recording, "against": compare}
        told, heard = self._process.stdin, self._process.stdout
        assert told is not None and heard is not None
        pickle.dump((scene, settings, asked), told)
        told.flush()  # and left open: when it closes, the viewer ends
        self.address = heard.readline().decode("utf-8").strip()
        if not self.address:
            self._process.wait()
            errors.seek(0)
            said = errors.read().decode("utf-8").strip().splitlines()
            raise TracerError(
                said[-1].removeprefix("castray: ") if said else "show: the viewer did not start"
            )

        RUNNING.append(self)

    @property
    def door(self):
        """Port and key."""
        port, _, key = self.address.rpartition(":")[2].partition("/?key=")
        return {"port": int(port), "key": key}

    def close(self):
        """End it."""
        if self in RUNNING:
            RUNNING.remove(self)
            self._process.communicate(timeout=20)  # closes its standard input


def child():
    """The process behind `show`: serves what it is told on standard input until that ends."""
    import _thread
    import threading

    from viewer.app import serve

    scene, settings, asked = pickle.load(sys.stdin.buffer)  # noqa: S301  from the process that started this one

    def watch():
        os.read(sys.stdin.fileno(), 1)  # not by the buffer, which this thread would hold at the end
        _thread.interrupt_main()

    threading.Thread(target=watch, daemon=True).start()
    try:
        serve(scene, settings, open_browser=False, framed=True, **asked)
    except TracerError as error:
        sys.exit(f"castray: {error}")
