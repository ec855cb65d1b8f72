"""The window on a session: what the page is told, and the walk that goes on by itself."""

import asyncio
from dataclasses import fields

import numpy as np

from tracer.settings import Settings, TracerError
from viewer.company import companions, over_vertex
from viewer.painting import Painting
from viewer.panels import all_panels
from viewer.panels.panel import LEVELS
from viewer.sendable import sendable
from viewer.stage import Stage
from viewer.words import LANGUAGES, Speaker

PLAY_SECONDS = 0.8
IN_THE_HEADER_ANYWAY = ("width", "height", "spp", "integrator")


class Window:
    """Shows a session in a trame server's state. Everything here runs in the server's event loop."""

    def __init__(self, server, session, say):
        self.server, self.state, self.session, self.say = server, server.state, session, say
        self.stage = Stage(session.scene)
        self.painting, self.playing, self.loop = Painting(self), None, None
        self.aimed = None  # the vertex whose hemisphere is looked at
        self.tab = None  # that is open on the page, as far as it has said
        self._build()
        self.refresh("picture")

    def back(self, call, *told):
        """Have a call made in the server's loop, from any thread, and the page told what it changed."""
        self.loop.call_soon_threadsafe(self._within, call, *told)

    def _within(self, call, *told):
        with self.state:
            call(*told)

    def _build(self):
        from trame_client.ui.html import DivLayout
        from trame_client.widgets import html
        from trame_vtk.modules.vtk import get_helper
        from trame_vtk.widgets.vtk import VtkLocalView

        from viewer.layout import LABELS, template

        server, state = self.server, self.state
        languages = [{"tag": tag, "name": name} for tag, name in LANGUAGES.items()]
        state.client_only("tab", "exposure", "wipe", "helped")
        first_tab = next(p.name for p in all_panels() if p.place == "tab")
        state.update(
            {
                "tab": first_tab,
                "exposure": 0,
                "wipe": 0.5,
                "owner": "",
                "touched": False,
                "helped": False,
                "languages": languages,
            }
        )
        self._put_words()
        state.update(
            {
                "message": "",
                "progress": "",
                "playing": False,
                "rgb": b"",
                "overlay_values": b"",
                "rival_rgb": b"",
                "camera": self.stage.camera,
            }
        )
        with DivLayout(server):
            view = VtkLocalView(self.stage.window, ref="view", connect_parent=False, trame_server=server)
            view.add_child(LABELS)
            html.Div(children=[template(view.html)], classes="fill")
        self.whole_stage, self._helper = view.update, get_helper(server)

    def _put_words(self):
        """What the page is told of its language."""
        self.state.update({"w": self.say.under("ui."), "language": self.say.language})

    def speak(self, language):
        """Say everything in another language."""
        if language != self.say.language:
            self.say = Speaker(language)
            self._put_words()
            self.painting.say_progress()
            self.refresh("picture")

    def refresh(self, level):
        """Show again what depends on a level or on what follows from it."""
        changed = LEVELS[LEVELS.index(level) :]
        session, cursor = self.session, self.session.cursor
        beside, over = companions(session, self.say), over_vertex(session, self.stage.size, self.say)
        self.stage.draw(session.record, cursor, level, beside, over)
        self._aim(over)
        for panel in all_panels():
            if panel.show and panel.level in changed:
                shut = panel.lazy and panel.name != self.tab
                self._tell({panel.name: None if shut else panel.show(session, self.say)})
        self._tell(
            {
                "path_index": cursor.path,
                "event_index": cursor.event,
                "labels": self.stage.labels,
                **{f"{name}_strokes": drawn for name, drawn in self.stage.strokes.items()},
                "companions": {name: True for name in beside},
                "over": over and over.legend(self.say),
                "link": session.link.write(),
                "header": self._header(),
            }
        )

    def _aim(self, over):
        """Look at the Hemisphere, when it comes or stands elsewhere; from the start again when it goes."""
        place = over and tuple(np.asarray(over.lens.vertex.hit["p"], float))
        if place != self.aimed:
            self.aimed, self.state.camera = place, over.viewpoint() if over else self.stage.camera

    def look(self, tab):
        """The reader looks at another tab."""
        self.tab, before = tab, self.tab
        if tab != before and any(p.name == tab and p.lazy for p in all_panels()):
            self.show(tab)

    def show(self, name):
        """Show one panel again."""
        panel = next(p for p in all_panels() if p.name == name)
        self._tell({name: panel.show(self.session, self.say)})

    def _tell(self, values):
        """Put values into the page's state: a path may hold numbers that are none."""
        self.state.update(sendable(values))

    def cover(self, overlay):
        """Lay an Overlay over the picture, or take away what lies there (None)."""
        before, self.session.overlay = self.session.overlay, overlay
        values = self.session.spread(overlay.values) if overlay else ()
        self.state.overlay_values = np.ascontiguousarray(values, np.float32).tobytes()
        for name in {"picture", *(laid.by for laid in (before, overlay) if laid)}:
            self.show(name)

    def go_to(self, place):
        """Turn to (x, y, path, event); event None: where the path is given most."""
        self.pause()
        self.session.stand(place)
        self.state.update({"touched": True, "message": ""})
        self.refresh("pixel")

    def open(self, link):
        """Turn to what a Link says."""
        before, against = self.session.scene, self.session.against
        self.pause()
        renewed = self.session.open(link)
        if renewed or (self.session.against != against and self.painting.gl):
            if self.session.scene is not before:
                self.furnish()
                self.state.rgb = b""
            self.painting.begin()
        else:
            self.painting.tell_begun()
        self.refresh("picture")

    def _push_surfaces(self):
        """Send what changed of the scene's surfaces; the whole is sent when a page asks for the state."""
        if self.server.protocol:
            changes = self._helper.scene(self.stage.window, new_state=False)
            self.server.protocol.publish("trame.vtk.delta", changes)

    def _header(self):
        s = self.session.settings
        said = [f"{s.width}×{s.height}", f"{s.spp} spp", s.integrator]
        for option in fields(Settings):
            value = getattr(s, option.name)
            if option.name not in IN_THE_HEADER_ANYWAY and value != option.default:
                said.append(f"{self.say.dial(option.name)} {self.say.dialed(value)}")
        return {"scene": self.session.scene.name, "settings": " · ".join(said)}

    def move(self, cursor):
        """Stand somewhere else in the picked pixel."""
        before, self.session.cursor = self.session.cursor, cursor
        if cursor != before:
            self.refresh("event" if cursor.path == before.path else "path")

    def alter(self, scene, settings):
        """Show the scene said differently, or with other settings: the picture anew, the rest at once."""
        self.pause()
        try:
            self.session.alter(scene, settings)
        except (TracerError, IndexError):
            self.painting.tell_begun()  # what panels keep of the scene may be gone
            raise
        self.painting.begin()  # first: it goes on beside what follows
        self.stage.refit(self.session.scene)
        self._push_surfaces()
        self.state.update({"touched": True, "message": ""})
        self.refresh("picture")
        self.painting.wait()

    def give(self, given):
        """Show the paths of another tracer in place of castray's own."""
        self.pause()
        self.session.give(given)
        self.stage.refit(self.session.scene)
        self._push_surfaces()
        self.state.update({"touched": True, "message": ""})
        self.painting.begin()
        self.refresh("picture")

    def furnish(self):
        """Show the session's scene in 3D in place of another."""
        self.stage.furnish(self.session.scene)
        self._push_surfaces()
        self.aimed, self.state.camera = None, self.stage.camera

    def play(self):
        """Walk on by itself; from the end it starts again."""
        if self.session.cursor.at_end:
            self.move(self.session.cursor.first())
        self.state.playing = True
        self.playing = asyncio.get_running_loop().create_task(self._walk())

    def pause(self):
        """Stop walking."""
        if self.playing:
            self.playing.cancel()
        self.playing, self.state.playing = None, False

    async def _walk(self):
        while not self.session.cursor.at_end:
            await asyncio.sleep(PLAY_SECONDS)
            with self.state:
                self.move(self.session.cursor.next())
        with self.state:
            self.playing, self.state.playing = None, False
