"""The comparer of a page: what the picture is compared with, its picture, the verdict, and the twin paths."""

from dataclasses import dataclass
from typing import Any

from tracer.settings import TracerError
from tracer.testing import compare
from viewer.comparing import first, maps, rival, twins
from viewer.comparing.twins import PixelTwin
from viewer.render import Painter
from viewer.worker import Stopped

WIPE = "wipe"


@dataclass
class Desk:
    """What lies before the reader of one scene and its settings, compared with one Rival."""

    rival: rival.Rival
    picture: Any = None  # the rival's, as far as it is rendered
    painter: Any = None
    verdict: Any = None  # on both pictures, once each is there
    first: tuple | None = None  # the pixel (x, y) to look at first
    error: TracerError | None = None
    pixel: tuple | None = None  # the pixel (x, y) that `twin` is of
    twin: PixelTwin | None = None
    untwinned: TracerError | None = None  # why there is none
    path: Any = None  # the recorded path that `beside` is of
    beside: Any = None
    wiped: bool = False  # whether both pictures are shown with a wipe between them
    whole: Any = None  # the Twin of paths from all over the picture
    searching: bool = False  # whether it is being found

    def close(self):
        """Give up the picture that is being rendered."""
        if self.painter:
            self.painter.stop()


def desk_of(session):
    """The Desk of a session that compares; None if it does not."""
    name, desk = session.against, session.desk.get("compare")
    if name and desk is None:
        there = session.rivals.get(name) or rival.of_scene(name, session.scene, session.settings)
        desk = session.desk["compare"] = Desk(there, there.picture)
    return desk


def beside(session):
    """The twin Beside the selected path; None where there is none."""
    desk = desk_of(session)
    if desk is None or not desk.rival.traced or session.given:
        return None
    pixel = session.cursor.x, session.cursor.y
    if desk.pixel != pixel:
        desk.pixel, desk.twin, desk.untwinned, desk.path = pixel, None, None, None
        try:
            desk.twin = PixelTwin(session.scene, session.settings, desk.rival, *pixel)
        except TracerError as error:
            desk.untwinned = error
    if desk.path is not session.path:
        desk.path = session.path
        desk.beside = desk.twin.beside(session.path.sample) if desk.twin else None
    return desk.beside


class Comparer:
    """What the page may ask. window: shows and covers; worker: does what takes long."""

    def __init__(self, window, worker):
        self.window, self.session, self.worker, self.view = window, window.session, worker, WIPE
        window.painting.followers.append(self)

    @property
    def desk(self):
        """The Desk, if there is something to compare with."""
        return desk_of(self.session)

    def choose(self, name):
        """Compare with a bug's tracer, the right one, or a file named at the start; "" with nothing."""
        if not isinstance(name, str) or not (name == "" or name in self.session.rivals or rival.known(name)):
            raise TracerError(f"compare: {str(name)[:40]!r} is not known here; choose one of the list")
        before, self.session.against = self.session.desk.pop("compare", None), name
        if before:
            before.close()
        if self.window.painting.gl:
            self.window.painting.begin()  # by whom, hangs on whether it is compared
        else:
            self.begun()
        self.window.refresh("path")

    def look(self, view):
        """Show both pictures by one of maps.VIEWS or WIPE, or the picture alone ("")."""
        if view not in ("", WIPE, *maps.VIEWS):
            raise TracerError(f"compare: {str(view)[:20]!r} is no view of two pictures")
        self.view = view
        self._cover()
        self.window.show("compare")

    def part(self):
        """Go to the first event that differs from the twin's."""
        there = beside(self.session)
        if there is None or there.parting is None:
            raise TracerError("compare: no event of this path differs from its twin's")
        step = there.parting.steps[0]
        cursor = self.session.cursor
        self.window.pause()
        self.window.move(cursor.last() if step is None else cursor.at(step))

    def go(self, index):
        """Go to one of the pixel's paths that differ most, where it parts."""
        found = self.desk.twin.found.largest if self.desk and self.desk.twin else ()
        if type(index) is not int or not 0 <= index < len(found):
            raise TracerError(f"compare: path {str(index)[:20]!r} is not one of the {len(found)} listed")
        self._go(found[index])

    def search(self):
        """Find where paths from all over the picture part."""
        desk, session = self.desk, self.session
        if desk is None or not desk.rival.traced or session.given:
            raise TracerError("compare: there is nothing whose paths could be traced again")
        if desk.searching:
            return
        desk.searching, desk.error = True, None
        scene, settings = session.scene, session.settings

        def stopped():
            if session.desk.get("compare") is not desk:
                raise Stopped

        def done(found):
            desk.searching, desk.whole = False, found
            self.window.show("compare")

        def failed(error):
            desk.searching, desk.error = False, error
            self.window.show("compare")

        self.worker.do(lambda: twins.whole(scene, settings, desk.rival, stopped), done, failed)
        self.window.show("compare")

    def cause(self, index):
        """Go to the example of one of the ways in which paths part."""
        causes = self.desk.whole.causes if self.desk and self.desk.whole else ()
        if type(index) is not int or not 0 <= index < len(causes):
            raise TracerError(f"compare: way {str(index)[:20]!r} is not one of the {len(causes)} there are")
        self._go(causes[index].example)

    def _go(self, parting):
        self.window.go_to(parting.place(parting.steps[0]))

    def begun(self):
        """The picture is rendered anew, or something else is compared with: begin the other one."""
        desk = self.desk
        if desk is not None and desk.rival.picture is None and desk.painter is None:
            self._paint(desk)
        self.painted()

    def painted(self):
        """One of the pictures has come further: judge them again."""
        desk, mine = self.desk, self.session.picture
        if desk is not None and mine is not None and desk.picture is not None:
            try:
                desk.verdict = compare(mine, desk.picture, names=("a", "b"))
                desk.first = first.pixel(mine, desk.picture, desk.verdict, self._same_numbers(desk))
            except TracerError as error:
                desk.verdict, desk.error = None, error
        self._cover()
        self.window.show("compare")

    def _same_numbers(self, desk):
        """Whether both pictures come from castray's own paths and the same random numbers."""
        beside(self.session)
        return desk.twin is not None

    def _paint(self, desk):
        """Render the rival's picture beside the page."""

        def here(call):
            return lambda *told: self.window.back(self._still, desk, call, *told)

        def done(picture, spp):
            desk.picture = picture
            self.painted()

        def failed(text):
            desk.error = TracerError(text)
            self.window.show("compare")

        desk.painter = Painter(desk.rival.scene, desk.rival.settings)
        desk.painter.start(here(done), lambda *told: None, here(failed))

    def _still(self, desk, call, *told):
        """The call, unless something else is compared with by now."""
        if self.desk is desk:
            call(*told)

    def _cover(self):
        """Lay over the picture what the view asks for."""
        desk, laid = self.desk, self.session.overlay
        if desk is not None and desk.verdict is not None and self.view in maps.possible(desk.verdict):
            mine = self.session.picture
            self.window.cover(maps.view(self.view, mine, desk.picture, desk.verdict))
        elif laid and laid.by == "compare":
            self.window.cover(None)
        wiped = desk is not None and desk.verdict is not None and self.view == WIPE
        if desk is not None:
            desk.wiped = wiped
        self.window.state.rival_rgb = desk.picture.rgb.tobytes() if wiped else b""
