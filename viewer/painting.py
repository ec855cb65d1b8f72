"""The picture in the making: begun anew, painted further in a thread of its own, and told to the page."""

import asyncio
import threading
from collections import deque

from viewer.render import COMPARED, Painter, passes

TOGETHER = 0.15  # seconds that words wait for a picture, so that the page is drawn once for both


class Post:
    """What a painter tells from its thread: read in the loop when it is there, or sooner by who waits."""

    def __init__(self, loop):
        self._loop, self._letters, self._awaited, self._wanted = loop, deque(), threading.Event(), True

    def sender(self, call, awaited=True):
        """The call, made in the loop; awaited: whether somebody waits for it."""

        def send(*words):
            self._letters.append((call, words))
            if awaited:
                self._awaited.set()
            self._loop.call_soon_threadsafe(self.read)

        return send

    def read(self):
        """Do what was told and has not been done."""
        while self._letters and self._wanted:
            call, words = self._letters.popleft()
            call(*words)

    def wait(self, seconds):
        """Wait, at most that long, for the first that somebody waits for."""
        self._awaited.wait(seconds)
        self.read()

    def refuse(self):
        """Do nothing more of what is told."""
        self._wanted = False


class Painting:
    """Paints the picture of a window's session. Everything here runs in the server's event loop."""

    def __init__(self, window):
        self.window, self.session, self.state = window, window.session, window.state
        self.followers = []  # told when a picture is begun() and when it has been painted() further
        self._painter, self._post, self._rendered = None, None, None
        self._pace = None  # seconds that a path of the last picture took

    def begin(self):
        """Begin the picture anew."""
        self.stop()
        settings = self.session.settings
        size = 12 * settings.width * settings.height
        if len(self.state.rgb) != size:  # else the picture before stays until there is a new one
            self.state.rgb = bytes(size)
        if self.session.given:
            self._painter = None
            self.tell_begun()
            self._painted(self.session.given.picture, settings.spp)
            return
        self._tell_progress(0, 1)
        compared = bool(self.session.against)
        painter = Painter(self.session.scene, settings, None if compared else self.gl)
        painter.why = COMPARED if compared and self.gl else ""

        self._painter, self._post = painter, Post(asyncio.get_running_loop())
        painted, failed = (self._post.sender(call) for call in (self._painted, self._failed))
        painter.start(painted, self._post.sender(self._progress, awaited=False), failed)
        self.tell_begun()

    def wait(self):
        """Take the first picture in with all else that is told now, where it can be there within TOGETHER."""
        settings = self.session.settings
        paths = settings.width * settings.height * passes(settings.spp)[0]
        if self._painter and self._pace is not None and paths * self._pace <= TOGETHER:
            self._post.wait(TOGETHER)

    def tell_begun(self):
        """Tell the followers that the picture is another."""
        for follower in self.followers:
            follower.begun()

    @property
    def gl(self):
        """The process that the picture is asked of first, if there is one."""
        return self.session.shelf.get("gl")

    def stop(self):
        """Give up the picture that is being rendered, if there is one."""
        if self._painter:
            self._painter.stop()
            self._post.refuse()

    def _painted(self, picture, spp):
        self.session.spp_done, self.session.picture = spp, picture
        self._pace = picture.seconds / picture.paths if self._painter else None
        self.session.numpy_why = self._painter.why if self._painter else ""
        complete = spp == self.session.settings.spp
        with self.state as state:
            state.rgb = self.session.spread(picture.rgb).tobytes()
            if self.gl:
                self.window.show("picture")  # who made it
            self._tell_progress(None if complete else 0, spp)
            for follower in self.followers:
                follower.painted()

    def _progress(self, share, spp):
        with self.state:
            self._tell_progress(share, spp)

    def _tell_progress(self, share, spp):
        """How far the picture is; share None: nothing is being rendered."""
        self._rendered = None if share is None else {"percent": round(100 * share), "spp": spp}
        self.say_progress()

    def say_progress(self):
        """Say how far it is, in the page's language."""
        self.state.progress = self.window.say("progress", **self._rendered) if self._rendered else ""

    def _failed(self, text):
        with self.state as state:
            self._tell_progress(None, 0)
            state.message = self.window.say.error(text)
