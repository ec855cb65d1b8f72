"""The finder of a page: asks the picture's events, keeps what came out, and goes there."""

from dataclasses import dataclass, field
from typing import Any

from tracer.settings import TracerError
from tracer.trace.breakpoints import BREAKPOINTS, condition
from viewer import overlay
from viewer.finding import maps, ranks, survey
from viewer.worker import Stopped

SHOWN = 200  # paths, or rows, that are listed
MASK = "overlay.mask"  # what the pixels of the paths found are called


@dataclass
class Desk:
    """What lies before the reader, of one scene and its settings."""

    survey: Any = None
    tracing: float | None = None  # share of the survey that is done
    waiting: list = field(default_factory=list)  # what is to be done with the survey when it is there
    asking: bool = False
    looking: bool = False  # over the survey, for the histogram and the fireflies
    text: str = ""  # what was asked last
    error: TracerError | None = None
    answer: dict | None = None
    hit: int = -1  # which of the answer's paths was gone to
    covering: str = ""  # what was last asked to lie over the picture: "map NAME" or "mask QUERY"
    brush: tuple | None = None
    histogram: ranks.Histogram | None = None
    fireflies: list = field(default_factory=list)

    def close(self):
        """Forget the survey."""
        if self.survey:
            self.survey.close()


class Finder:
    """What the page may ask. window: shows and covers; tracing, asking: two Workers."""

    def __init__(self, window, tracing, asking):
        self.window, self.session = window, window.session
        self.tracing, self.asking = tracing, asking

    @property
    def desk(self):
        """The Desk of the session's scene."""
        return self.session.desk.setdefault("find", Desk())

    def prepare(self):
        """Trace the picture to be asked, if that has not been done."""
        self._with_survey(lambda there: None)

    def ask(self, text):
        """Ask for the paths that a text means, as `castray query` does."""
        if not isinstance(text, str):
            raise TracerError("query: not a text")
        self.desk.brush = None
        self._ask(text)

    def stop_at(self, name):
        """Ask for what a named breakpoint means."""
        if not isinstance(name, str) or name not in BREAKPOINTS:
            raise TracerError(
                f"break: {str(name)[:20]!r} is not known; choose one of {', '.join(BREAKPOINTS)}"
            )
        self.desk.brush = None
        self._with_survey(lambda there: self._ask(condition(name, there.level)))

    def brushed(self, low, high):
        """Ask for the paths with a contribution in some bins of the histogram."""
        desk = self.desk
        bins = range(len(desk.histogram.counts)) if desk.histogram else ()
        if type(low) is not int or type(high) is not int or low not in bins or high not in bins or high < low:
            raise TracerError("find: there are no such bins")
        desk.brush = (low, high)
        self._ask(desk.histogram.condition(low, high))

    def show_map(self, name):
        """Lay a heat map over the picture, or none."""
        desk = self.desk
        if name == "":
            desk.covering = ""
            self._uncover()
            self._say()
            return
        if not isinstance(name, str) or name not in maps.MAPS:
            raise TracerError(f"map: {str(name)[:20]!r} is not known; choose one of {', '.join(maps.MAPS)}")
        desk.covering = f"map {name}"
        self._with_survey(lambda there: self._begin(lambda: maps.values(there, name), self._mapped(name)))

    def hit(self, index):
        """Go to one of the paths found: to its first matching event."""
        found = (self.desk.answer or {}).get("found", ())
        if type(index) is not int or not 0 <= index < len(found):
            raise TracerError(f"find: hit {str(index)[:20]!r} is not one of the {len(found)} listed")
        self.desk.hit = index
        path = found[index]
        self._go((path["x"], path["y"], path["sample"], path["step"]))

    def step(self, by):
        """Go to the next or the previous of the paths found."""
        found = (self.desk.answer or {}).get("found", ())
        if found and by in (-1, 1):
            first = self.desk.hit < 0
            self.hit(0 if first else (self.desk.hit + by) % len(found))

    def firefly(self, index):
        """Go to a firefly, to the event that gives most."""
        listed = self.desk.fireflies
        if type(index) is not int or not 0 <= index < len(listed):
            raise TracerError(f"find: firefly {str(index)[:20]!r} is not one of the {len(listed)} listed")
        path = listed[index]
        self._go((path["x"], path["y"], path["sample"], None))

    def _go(self, place):
        self.window.go_to(place)
        self._say()

    def _ask(self, text):
        desk = self.desk
        desk.text, desk.error, desk.answer, desk.hit = text, None, None, -1
        desk.covering = f"mask {text}"
        self._with_survey(
            lambda there: self._begin(
                lambda: there.asker.ask(text, SHOWN, survey.LONGEST), self._answered(text)
            )
        )

    def _with_survey(self, then):
        """Do what needs the survey, now or when it is there."""
        desk, given = self.desk, self.session.given
        if given is not None:
            raise TracerError(f"find: asks castray's own paths, not those of {given.name}")
        if desk.survey is None and self.session.recording is not None:
            desk.survey = survey.of_recording(self.session.recording)
            self._look_over(desk)
        if desk.survey is not None:
            then(desk.survey)
        else:
            survey.planned(self.session.settings)  # refuses at once what is too large
            desk.waiting.append(then)
            if desk.tracing is None:
                self._trace(desk)
        self._say()

    def _trace(self, desk):
        """Begin the survey."""
        session, back = self.session, self.window.back
        scene, settings = session.scene, session.settings
        desk.tracing, desk.error = 0.0, None

        def progress(part, total):
            if session.desk.get("find") is not desk:
                raise Stopped
            back(self._advanced, desk, part / total)

        def done(there):
            if session.desk.get("find") is not desk:
                there.close()
                return
            desk.tracing, desk.survey = None, there
            self._look_over(desk)
            waiting, desk.waiting = desk.waiting, []
            for then in waiting:
                then(there)
            self._say()

        self.tracing.do(lambda: survey.traced(scene, settings, progress), done, self._failed(desk))

    def _look_over(self, desk):
        """What is shown of every survey: the histogram and the fireflies."""
        there, desk.looking = desk.survey, True

        def done(found):
            desk.looking = False
            desk.histogram, desk.fireflies = found
            self._say()

        self.asking.do(lambda: (ranks.histogram(there), ranks.fireflies(there)), done, self._failed(desk))

    def _begin(self, job, done):
        desk = self.desk
        desk.asking, desk.error = True, None

        def finished(answer):
            desk.asking = False
            if self.session.desk.get("find") is desk:
                done(desk, answer)
                self._say()

        self.asking.do(job, finished, self._failed(desk))

    def _answered(self, text):
        def done(desk, answer):
            if desk.text != text:  # something else was asked meanwhile
                return
            desk.answer = answer
            if answer.get("found"):
                if desk.covering == f"mask {text}":
                    cover = overlay.mask("find", MASK, answer["mask"], desk.survey.settings)
                    self.window.cover(cover)
            elif self.session.overlay and self.session.overlay.title == MASK:  # of what was asked before
                self.window.cover(None)

        return done

    def _mapped(self, name):
        def done(desk, values):
            if desk.covering == f"map {name}":
                one = maps.MAPS[name]
                self.window.cover(overlay.scaled("find", f"map.{name}", values, one.log, one.share))

        return done

    def _failed(self, desk):
        def failed(error):
            desk.tracing, desk.waiting, desk.error = None, [], error
            desk.asking = desk.looking = False
            self._uncover()
            self._say()

        return failed

    def _advanced(self, desk, share):
        if desk.tracing is not None:
            desk.tracing = share
            self._say()

    def _uncover(self):
        if self.session.overlay and self.session.overlay.by == "find":
            self.window.cover(None)

    def _say(self):
        self.window.show("find")
