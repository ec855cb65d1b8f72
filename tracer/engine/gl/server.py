"""The gl engine in a process of its own, for whoever must not wait for a driver.

Calls of OpenGL hold Python's lock while a driver compiles and draws, whichever thread makes them, and a
context belongs to one thread. A process has its context to itself, keeps it and the shaders from one picture
to the next, and takes nobody with it when the driver falls.
"""

import multiprocessing
import signal
import threading
from contextlib import contextmanager

from tracer.settings import TracerError

PATIENCE = 0.05  # seconds; whoever has heard nothing by then does something else meanwhile
_STOP = "stop"


class Server:
    """A child process that renders by gl, one picture after another, whoever asks.

    auto: it refuses where OpenGL is drawn by the processor, as engine auto does.
    """

    def __init__(self, auto=False):
        self.asked = "auto" if auto else "gl"  # the engine, as an option names it
        context = multiprocessing.get_context("spawn")
        self._line, theirs = context.Pipe()
        self._child = context.Process(target=_serve, args=(theirs, auto), daemon=True)
        with _deaf():
            self._child.start()
        theirs.close()
        self._free = threading.Lock()  # whoever has it has the child
        self._greeted, self._busy, self._refused = False, True, None
        self._sent = None  # the scene that the child has
        self.renderer = ""  # who draws, as the driver calls it, once that is known

    def greet(self):
        """Wait until it has started. Raises TracerError without OpenGL, or where auto leaves it alone."""
        if self._refused:
            raise self._refused
        if not self._greeted:
            try:
                self.renderer = self._answer(None)
            except TracerError as error:
                self._refused = error
                raise
            self._greeted = True

    def render(self, scene, settings, steps, progress, meanwhile=None):
        """The Picture of engine.render; progress may raise to stop it. meanwhile: called where nothing is
        heard of it for a moment, since the child starts, is at another one, or its driver compiles. Raises
        TracerError where gl cannot do it."""
        with self._lent(meanwhile) as meanwhile:
            progress(0, settings.spp)  # whoever had the child may have had it for long
            if not (self._greeted or self._refused):
                meanwhile = self._patient(meanwhile)
            self.greet()
            self._send((None if scene is self._sent else scene, settings, steps))
            self._busy, self._sent = True, scene
            try:
                self._patient(meanwhile)
                return self._answer(progress)
            finally:
                self._settle()

    def close(self):
        """End the child, whatever it is at."""
        self._line.close()
        self._child.terminate()
        self._child.join()

    @contextmanager
    def _lent(self, meanwhile):
        """The child is the caller's. Gives what is left to be called meanwhile."""
        if not self._free.acquire(timeout=PATIENCE if meanwhile else -1):
            meanwhile()
            meanwhile = None
            self._free.acquire()
        try:
            yield meanwhile
        finally:
            self._free.release()

    def _patient(self, meanwhile):
        """Call it if nothing is heard for a moment; what is left to be called."""
        if meanwhile is None or self._line.poll(PATIENCE):
            return meanwhile
        meanwhile()
        return None

    def _settle(self):
        """What was asked for is not wanted any more, if it is still being done."""
        if self._busy and not self._refused:
            self._send(_STOP)
            while self._busy:
                self._heard()

    def _answer(self, progress):
        """What the child answers, after its reports of progress."""
        while self._busy:
            kind, said = self._heard()
            if kind == "error":
                raise said
            if kind == "progress":
                progress(*said)
        return said

    def _heard(self):
        """The next that it says."""
        try:
            kind, said = self._line.recv()
        except (EOFError, OSError):
            raise self._ended() from None
        self._busy = kind == "progress"
        return kind, said

    def _send(self, words):
        try:
            self._line.send(words)
        except OSError:
            raise self._ended() from None

    def _ended(self):
        self._busy = False
        self._refused = TracerError("engine: the process that traces by gl has ended; choose engine numpy")
        return self._refused


@contextmanager
def _deaf():
    """A child that starts now does not hear Ctrl-C, which is for this process, not even while it imports."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


class _Stopped(Exception):
    """What is being rendered is not wanted any more."""


def _serve(line, auto):
    """The child's life: render what is asked until the other end is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    scene = None
    try:
        _greet(line, auto)
        while True:
            asked = line.recv()
            if asked == _STOP:  # which came too late
                continue
            another, *more = asked
            scene = scene if another is None else another
            line.send(_rendered(line, scene, *more))
    except (EOFError, OSError):
        return


def _greet(line, auto):
    from tracer.engine.gl.choice import by_processor
    from tracer.engine.gl.device import renderer

    try:
        against = by_processor() if auto else ""
        line.send(("error", TracerError(against)) if against else ("answer", renderer()))
    except TracerError as error:
        line.send(("error", error))


def _rendered(line, scene, settings, steps):
    """What there is to say of a picture in the end."""
    from tracer.engine.picture import render

    def report(done, total):
        if line.poll() and line.recv() == _STOP:
            raise _Stopped
        line.send(("progress", (done, total)))

    try:
        return "answer", render(scene, settings, report, steps=steps, engine="gl")
    except _Stopped:
        return "error", TracerError("engine: stopped")
    except TracerError as error:
        return "error", error
    except (EOFError, OSError):
        raise
    except Exception as error:  # a driver's own, such as one without memory
        return "error", TracerError(f"engine: {type(error).__name__}: {' '.join(str(error).split())}")
