"""The viewer as a program: a server on this machine, its address, and how it ends."""

import asyncio
import errno
import gc
import importlib.util
import sys
import webbrowser
from pathlib import Path

import tracer
from lessons.course import lesson
from tracer.scene_file.change import changed
from tracer.settings import TracerError
from viewer import link as links
from viewer.comparing import rival
from viewer.security import STATIC, Door, files, page, restrict
from viewer.session import Session
from viewer.words import Speaker


def serve(
    scene,
    settings,
    port=None,
    open_browser=True,
    start=None,
    recording=None,
    what_if=None,
    lesson=None,
    against=None,
    framed=False,
    engine="numpy",
):
    """Open the viewer on a loaded scene until Ctrl-C; prints its address alone on one line of stdout.

    start: (x, y, path, event), or None for a telling place; recording: the Folder that it is of; what_if:
    suppositions about the path there; lesson: the number of one to be read; against: what the picture is
    compared with, a bug's id or a file; framed: whether pages of this machine may show it in a frame;
    engine: who makes the picture, "numpy", "gl" where it can, or "auto".
    TracerError where port, place or engine will not do.
    """
    there = None if against is None or rival.known(against) else rival.of_file(against)
    if there is not None:
        settings = rival.fitted(settings, there)
    session = Session(scene, settings, Scenes(scene).find, recording)
    session.against, session.rivals = against or "", {against: there} if there else {}
    try:
        session.stand(start)
        session.suppose(what_if or {})
    except IndexError as error:
        raise TracerError(f"link: {error}: there is no such place") from None
    _run(session, port, open_browser, lesson, framed, engine)


def serve_learner(file, scene, settings, port=None, open_browser=True, against=None, at=None):
    """Open the viewer on a learner's own tracer of a scene (a file or name), which runs whenever its file is
    saved; castray's own picture stands there until the first run is done, which is opened at the place `at`,
    (x, y, path, event), where that is there."""
    from viewer.opening.learner import Watched

    loaded = tracer.load(scene)
    session = Session(loaded, settings, Scenes(loaded).find)
    session.against = against or ""
    session.shelf["watched"] = Watched(file, scene, settings, at)
    session.stand(None)
    _run(session, port, open_browser)


def serve_given(given, port=None, open_browser=True, against=None):
    """Open the viewer on the paths of another tracer."""
    session = Session(given.scene, given.settings, Scenes(given.scene).find)
    session.against = against or ""
    session.give(given)
    _run(session, port, open_browser)


def serve_lesson(number, port=None, open_browser=True, engine="numpy"):
    """Open the viewer where a lesson begins, the lesson beside it."""
    start = links.of_moment(lesson(number).moments["start"])
    scene = changed(tracer.load(start.scene), start.changes)
    serve(scene, start.settings, port, open_browser, start.place, lesson=number, engine=engine)


def serve_link(text, port=None, open_browser=True, against=None, engine="numpy"):
    """Open the viewer where a link points; against: another thing to compare with than the link names."""
    asked = links.parse(text)
    against = against or asked.compare or None
    scene = changed(Scenes().find(asked.scene), asked.changes)
    more = {"what_if": asked.what_if, "against": against, "engine": engine}
    serve(scene, asked.settings, port, open_browser, asked.place, **more)


class Scenes:
    """The scenes a link may name: those the server was started with, and the built-in ones."""

    def __init__(self, *scenes):
        self.loaded = {scene.name: scene for scene in scenes}

    def find(self, name):
        """The scene of that name; TracerError where a link may not name it."""
        if name not in self.loaded:
            if name not in tracer.built_in_scenes():
                known = ", ".join(sorted({*self.loaded, *tracer.built_in_scenes()}))
                raise TracerError(f"link: scene {name[:80]!r} is not known here; known: {known}")
            self.loaded[name] = tracer.load(name)
        return self.loaded[name]


def _run(session, port, open_browser, number=None, framed=False, engine="numpy"):
    gl = _gl_server(engine)  # before what follows, which takes long to import
    if gl is not None:
        session.shelf["gl"] = gl
    from viewer.calls import Calls
    from viewer.opening.routes import serve_opening
    from viewer.sharing.routes import serve_files
    from viewer.window import Window

    say = Speaker()
    server = _trame(say("title"))
    window, door = Window(server, session, say), Door(page(say("title")), framed)
    calls = Calls(window).by_name

    def bind(web_server):
        web_server.app.middlewares.append(door.middleware)
        restrict(web_server, calls, window.whole_stage)
        serve_files(web_server, window)
        serve_opening(web_server, window, calls)

    def ready(**_):
        window.loop = asyncio.get_running_loop()
        address = f"http://127.0.0.1:{server.port}/?key={door.key}"
        print(address, flush=True)
        if sys.stderr.isatty():
            print(f"castray: {say('told.opened')}", file=sys.stderr)
        _begin(window, calls, number)
        if open_browser:
            webbrowser.open(address)

    server.controller.on_server_bind.add(bind)
    server.controller.on_server_ready.add(ready)
    gc.freeze()  # what was imported stays: a search through it for garbage held up whoever waited then
    try:
        if engine == "gl":
            gl.greet()
        _listen(server, port)
    except KeyboardInterrupt:
        pass
    finally:
        _end(window)
    print(f"castray: {Speaker()('told.closed')}", file=sys.stderr)


def _trame(title):
    """trame's server, which serves our styles and scripts."""
    from trame.app import get_server

    server = get_server("castray", client_type="vue3")
    served = {"castray": str(STATIC), "fonts": _fonts()}
    scripts = [f"castray/{name}" for name in files(".js") if name != "boot.js"]
    server.enable_module({"serve": served, "scripts": scripts, "vue_use": ["castray"]})
    server.state.trame__title = title
    return server


def _begin(window, calls, number):
    """What goes on from the start: the picture, a learner's tracer, a lesson of that number if any."""
    from viewer.opening.routes import show_findings

    session, watched = window.session, window.session.shelf.get("watched")

    def shown(given):
        window.give(given)
        if watched.runs == 1:
            show_findings(window)

    window.painting.begin()
    if watched is not None:
        watched.start(window.back, shown, lambda: window.show("given"))
    if session.given is not None:
        show_findings(window)
    if number is not None:
        with window.state as state:
            state.tab = "lesson"
            calls["lesson_open"](number)


def _end(window):
    """End what works beside the page."""
    shelf = window.session.shelf
    window.painting.stop()
    if "gl" in shelf:
        shelf["gl"].close()
    if "watched" in shelf:
        shelf["watched"].stop()
    window.session.close()


def _gl_server(engine):
    """The process of the gl engine, begun; None where it is not asked for."""
    if engine == "numpy":
        return None
    from tracer.engine.gl.server import Server

    return Server(auto=engine == "auto")


def _listen(server, port):
    """Serve until the end. The command line is not trame's to read."""
    options = server.cli.parse_known_args([])
    options[0].nowscompress = True  # the way to a browser on the same machine is not what takes time
    server.cli.parse_known_args = lambda: options
    try:
        server.start(
            port=port or 0,
            host="127.0.0.1",
            timeout=0,
            open_browser=False,
            show_connection_info=False,
            disable_logging=True,
        )
    except OSError as error:
        if error.errno not in (errno.EADDRINUSE, errno.EACCES):
            raise
        raise TracerError(
            f"port {port}: cannot be used ({error.strerror}); choose another, or none"
        ) from None


def _fonts():
    """The folder of the maths font, inside the package that ships it."""
    package = importlib.util.find_spec("ziamath")
    if package is None or package.origin is None:
        raise TracerError("the maths font is missing: install ziamath")
    return str(Path(package.origin).parent / "fonts")
