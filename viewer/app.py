"""The viewer as a server: a session, the panels that show it, the 3D view, and the few calls a page may make."""

import asyncio
import errno
import sys
import webbrowser
from dataclasses import fields
from pathlib import Path

import tracer
from tracer.settings import Settings, TracerError
from viewer import link as links
from viewer.cursor import MOVES
from viewer.panels import all_panels
from viewer.panels.panel import LEVELS
from viewer.render import Painter
from viewer.security import STATIC, Door, page, restrict
from viewer.session import Session
from viewer.words import Speaker

PLAY_SECONDS = 0.8
MOST_DIGITS = 9


class Viewer:
    """One window on one session. Everything here runs in the server's event loop."""

    def __init__(self, scene, settings, start=None):
        from trame.app import get_server
        from trame_vtk.modules.vtk import get_helper

        from viewer.stage import Stage

        self.say = Speaker()
        self.door = Door(page(self.say("title")))
        self.session = Session(scene, settings, self._load)
        self.scenes = {scene.name: scene}
        self.session.stand(start)
        self.server = get_server("castray", client_type="vue3")
        self.state = self.server.state
        self.stage = Stage(scene)
        self.painter, self.playing = None, None
        self._set_up(get_helper)

    def _set_up(self, get_helper):
        from trame_client.ui.html import DivLayout
        from trame_client.widgets import html
        from trame_vtk.widgets.vtk import VtkLocalView

        from viewer.layout import template

        server, state = self.server, self.state
        server.enable_module(
            {"serve": {"castray": str(STATIC), "fonts": _fonts()}, "scripts": ["castray/castray.js"], "vue_use": ["castray"]}
        )
        state.trame__title = self.say("title")
        state.client_only("tab", "exposure")
        first_tab = next(p.name for p in all_panels() if p.place == "tab")
        state.update({"tab": first_tab, "exposure": 0, "w": self.say.under("ui."), "owner": "", "touched": False})
        state.update({"message": "", "progress": "", "playing": False, "rgb": b"", "camera": self.stage.camera})
        with DivLayout(server):
            view = VtkLocalView(self.stage.window, ref="view", connect_parent=False, trame_server=server)
            html.Div(children=[template(view.html)], classes="fill")
        self.view, self.helper = view, get_helper(server)
        self.refresh("picture")
        server.controller.on_server_bind.add(self._bind)
        server.controller.on_server_ready.add(self._ready)

    # what a page may ask for; every argument comes from outside and is checked here

    @property
    def triggers(self):
        """The calls open to a page, by name."""
        calls = {
            "go": self.go,
            "pick": self.pick,
            "path": self.to_path,
            "event": self.to_event,
            "play": self.play,
            "open": self.open,
            "take": self.take,
            "dismiss": self.dismiss,
            "truth": self.truth,
        }
        return {name: self._told(call) for name, call in calls.items()}

    def _told(self, call):
        """The same call; what it refuses is shown to the reader as one line."""

        def told(*args):
            try:
                answer = call(*args)
            except (TracerError, IndexError) as error:
                self.state.message = str(error)
                return None
            return answer

        return told

    def go(self, move, *_):
        """Move the cursor by one of MOVES."""
        if move not in MOVES:
            raise TracerError(f"move: {str(move)[:20]!r} is not known; choose one of {', '.join(MOVES)}")
        self._stop_playing()
        self._move(getattr(self.session.cursor, move)())

    def pick(self, x, y):
        """Pick a pixel."""
        s = self.session.settings
        x, y = _whole("x", x, s.width), _whole("y", y, s.height)
        self._stop_playing()
        self.session.pick(x, y)
        self.state.update({"touched": True, "message": ""})
        self.refresh("pixel")

    def to_path(self, index):
        """Select a path by its place."""
        self._stop_playing()
        self._move(self.session.cursor.on(_whole("path", index, len(self.session.record.paths))))

    def to_event(self, index):
        """Go to an event of the selected path."""
        self._stop_playing()
        self._move(self.session.cursor.at(_whole("event", index, 2**31)))

    def play(self, *_):
        """Walk on by itself, or stop; from the end it starts again."""
        if self.playing:
            self._stop_playing()
            return
        if self.session.cursor.at_end:
            self._move(self.session.cursor.first())
        self.state.playing = True
        self.playing = asyncio.get_running_loop().create_task(self._play())

    def open(self, text):
        """Turn to what a link says."""
        if not isinstance(text, str):
            raise TracerError("link: not a text")
        asked, before = links.parse(text), self.session.scene
        self._stop_playing()
        if self.session.open(asked):
            if self.session.scene is not before:
                self.stage.furnish(self.session.scene)
                self.state.camera = self.stage.camera
            self.paint()
        self.refresh("picture")

    def take(self, tab, asked=""):
        """A tab leads from now on; asked is the link in its address."""
        if not (isinstance(tab, str) and 0 < len(tab) <= 64):
            raise TracerError("tab: expected a short text")
        self.state.owner = tab
        if asked and asked != self.state.link:
            self.open(asked)

    def dismiss(self):
        """Take the message away."""
        self.state.message = ""

    def truth(self):
        """What the server knows, for tests: the place, the link, the record as `castray inspect --json` has it."""
        c = self.session.cursor
        return {
            "cursor": {"x": c.x, "y": c.y, "path": c.path, "event": c.event},
            "link": self.session.link.write(),
            "spp_done": self.session.spp_done,
            "spp": self.session.settings.spp,
            "record": self.session.record.as_dict(self.session.scene),
        }

    # what follows from a change

    def _move(self, cursor):
        before, self.session.cursor = self.session.cursor, cursor
        if cursor != before:
            self.refresh("event" if cursor.path == before.path else "path")

    def refresh(self, level):
        """Show again what depends on a level or on what follows from it."""
        changed = LEVELS[LEVELS.index(level) :]
        session, cursor = self.session, self.session.cursor
        for panel in all_panels():
            if panel.show and panel.level in changed:
                self.state[panel.name] = panel.show(session, self.say)
        self.stage.draw(session.record, cursor, level)
        self.state.update(
            {
                "path_index": cursor.path,
                "event_index": cursor.event,
                "labels": self.stage.labels,
                "link": session.link.write(),
                "header": self._header(),
            }
        )
        self._push_stage()

    def _push_stage(self):
        """Send what changed in 3D; the whole is sent when a page asks for the state."""
        if self.server.protocol:
            self.server.protocol.publish("trame.vtk.delta", self.helper.scene(self.stage.window, new_state=False))

    def _header(self):
        s = self.session.settings
        said = [f"{s.width}×{s.height}", f"{s.spp} spp", s.integrator]
        plain = ("width", "height", "spp", "integrator")
        said += [f"{f.name} {getattr(s, f.name)}" for f in fields(Settings) if f.name not in plain and getattr(s, f.name) != f.default]
        return {"scene": self.session.scene.name, "settings": " · ".join(said)}

    async def _play(self):
        while not self.session.cursor.at_end:
            await asyncio.sleep(PLAY_SECONDS)
            with self.state:
                self._move(self.session.cursor.next())
        with self.state:
            self.state.playing, self.playing = False, None

    def _stop_playing(self):
        if self.playing:
            self.playing.cancel()
        self.playing, self.state.playing = None, False

    # the picture

    def paint(self):
        """Begin the picture anew."""
        if self.painter:
            self.painter.stop()
        loop = asyncio.get_running_loop()
        settings = self.session.settings
        blank = bytes(12 * settings.width * settings.height)
        self.state.update({"rgb": blank, "progress": self.say("progress", percent=0, spp=1)})
        painter = None

        def later(call):
            return lambda *args: loop.call_soon_threadsafe(lambda: call(*args) if painter is self.painter else None)

        painter = Painter(self.session.scene, settings, later(self._painted), later(self._progress), later(self._failed))
        self.painter = painter

    def _painted(self, rgb, spp):
        self.session.rgb, self.session.spp_done = rgb, spp
        complete = spp == self.session.settings.spp
        with self.state as state:
            state.rgb = rgb.tobytes()
            state.progress = "" if complete else self.say("progress", percent=0, spp=spp)

    def _progress(self, share, spp):
        with self.state as state:
            state.progress = self.say("progress", percent=round(100 * share), spp=spp)

    def _failed(self, text):
        with self.state as state:
            state.update({"message": text, "progress": ""})

    # the server

    def _load(self, name):
        """A scene that a link may name: one this server was started with, or a built-in one."""
        if name not in self.scenes:
            if name not in tracer.built_in_scenes():
                known = ", ".join(sorted({*self.scenes, *tracer.built_in_scenes()}))
                raise TracerError(f"link: scene {name[:80]!r} is not known here; known: {known}")
            self.scenes[name] = tracer.load(name)
        return self.scenes[name]

    def _bind(self, web_server):
        web_server.app.middlewares.append(self.door.middleware)
        restrict(web_server, self.triggers, self._whole_stage)

    def _whole_stage(self):
        self.view.update()

    def _ready(self, **_):
        address = f"http://127.0.0.1:{self.server.port}/?key={self.door.key}"
        print(address, flush=True)
        self.paint()
        if self.open_browser:
            webbrowser.open(address)

    def run(self, port, open_browser):
        """Serve until Ctrl-C."""
        self.open_browser = open_browser
        try:
            self.server.cli.parse_known_args = lambda: _options(self.server.cli)
            self.server.start(
                port=port or 0, host="127.0.0.1", timeout=0, open_browser=False, show_connection_info=False, disable_logging=True
            )
        except OSError as error:
            if error.errno not in (errno.EADDRINUSE, errno.EACCES):
                raise
            raise TracerError(f"port {port}: cannot be used ({error.strerror}); choose another, or none") from None
        except KeyboardInterrupt:
            pass
        finally:
            if self.painter:
                self.painter.stop()
        print("castray: viewer closed", file=sys.stderr)


def serve(scene, settings, port=None, open_browser=True, start=None):
    """Open the viewer on a loaded scene and serve until Ctrl-C; prints its address alone on one line of stdout.

    start: (x, y, path, event), or None for a telling place. TracerError where the port or the place will not do.
    """
    Viewer(scene, settings, start).run(port, open_browser)


def serve_link(text, port=None, open_browser=True):
    """Open the viewer where a link points."""
    asked = links.parse(text)
    if asked.scene not in tracer.built_in_scenes():
        raise TracerError(f"link: scene {asked.scene[:80]!r} is not built in; built in: {', '.join(sorted(tracer.built_in_scenes()))}")
    serve(tracer.load(asked.scene), asked.settings, port, open_browser, asked.place)


def _fonts():
    """The folder of the maths font, inside the package that ships it."""
    import importlib.util

    return str(Path(importlib.util.find_spec("ziamath").origin).parent / "fonts")


def _options(parser):
    """trame's own options at their defaults: the command line is not trame's to read."""
    return type(parser).parse_known_args(parser, [])


def _whole(name, value, end):
    """A whole number from outside in 0..end-1."""
    text = str(value).strip()
    if isinstance(value, bool) or not isinstance(value, (int, str)) or len(text) > MOST_DIGITS or not text.isdecimal():
        raise TracerError(f"{name}: {text[:20]!r} is not a whole number from 0 to {end - 1}")
    if int(text) >= end:
        raise TracerError(f"{name}: {int(text)} is not between 0 and {end - 1}")
    return int(text)
