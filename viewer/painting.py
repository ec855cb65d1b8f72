"""The picture in the making: begun anew, painted further in a thread of its own, and told to the page."""

import asyncio

from viewer.render import COMPARED, Painter


class Painting:
    """Paints the picture of a window's session. Everything here runs in the server's event loop."""

    def __init__(self, window):
        self.window, self.session, self.state = window, window.session, window.state
        self.followers = []  # told when a picture is begun() and when it has been painted() further
        self._painter, self._rendered = None, None

    def begin(self):
        """Begin the picture anew."""
        self.stop()
        loop, settings = asyncio.get_running_loop(), self.session.settings
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

        def here(call):
            """The call made in the loop, from the painter's thread; not of a painter that was replaced."""
            return lambda *told: loop.call_soon_threadsafe(
                lambda: call(*told) if painter is self._painter else None
            )

        self._painter = painter
        painter.start(here(self._painted), here(self._progress), here(self._failed))
        self.tell_begun()

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

    def _painted(self, picture, spp):
        self.session.spp_done, self.session.picture = spp, picture
        self.session.numpy_why = self._painter.why if self._painter else ""
        complete = spp == self.session.settings.spp
        with self.state as state:
            state.rgb = picture.rgb.tobytes()
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
