"""What a page may ask for, and nothing else. Every argument comes from outside and is checked here."""

from functools import wraps

from tracer.settings import TracerError
from viewer import link as links
from viewer.cursor import MOVES
from viewer.panels import all_panels
from viewer.words import LANGUAGES

OWN = "go pick back uncover look path event at play open take speak dismiss truth".split()
MOST_DIGITS = 9
LONGEST_TAB = 64


class Calls:
    """The calls open to a page, by name; what they refuse is shown to the reader as one line."""

    def __init__(self, window):
        self.window, self.session, self.state = window, window.session, window.state
        calls = {name: getattr(self, name) for name in OWN}
        for panel in all_panels():
            calls |= panel.calls(window) if panel.calls else {}
        self.by_name = {name: self._told(call) for name, call in calls.items()}

    def _told(self, call):
        @wraps(call)
        def told(*args):
            try:
                return call(*args)
            except (TracerError, IndexError) as error:
                self.state.message = self.window.say.error(str(error))
                return None

        return told

    def go(self, move, *_):
        """Move the cursor by one of MOVES."""
        if move not in MOVES:
            raise TracerError(f"move: {str(move)[:20]!r} is not known; choose one of {', '.join(MOVES)}")
        self.window.pause()
        self.window.move(getattr(self.session.cursor, move)())

    def pick(self, x, y):
        """Pick a pixel."""
        settings = self.session.settings
        x, y = whole("x", x, settings.width), whole("y", y, settings.height)
        if self.session.given is not None:
            x, y = self.session.given.near(x, y)
        self.window.pause()
        self.session.pick(x, y)
        self.state.update({"touched": True, "message": ""})
        self.window.refresh("pixel")

    def back(self, by):
        """Turn to a pixel that was picked before, or after this one."""
        if by not in (-1, 1):
            raise TracerError("back: goes by -1 or 1")
        pixel = self.session.history.moved(by)
        if pixel is not None:
            self.window.pause()
            self.session.pick(*pixel)
            self.window.refresh("pixel")

    def uncover(self):
        """The picture alone, with nothing laid over it."""
        self.window.cover(None)

    def look(self, tab):
        """Open a tab."""
        tabs = [panel.name for panel in all_panels() if panel.place == "tab"]
        if tab not in tabs:
            raise TracerError(f"tab: {str(tab)[:20]!r} is not known; choose one of {', '.join(tabs)}")
        self.window.look(tab)

    def path(self, index):
        """Select a path by its place."""
        index = whole("path", index, len(self.session.record.paths))
        self.window.pause()
        self.window.move(self.session.cursor.on(index))

    def event(self, index):
        """Go to an event of the selected path."""
        index = whole("event", index, self.session.cursor.lengths[self.session.cursor.path])
        self.window.pause()
        self.window.move(self.session.cursor.at(index))

    def at(self, path, event):
        """Go to an event of any path of the pixel."""
        lengths = self.session.cursor.lengths
        path = whole("path", path, len(lengths))
        event = whole("event", event, lengths[path])
        self.window.pause()
        self.window.move(self.session.cursor.on(path).at(event))

    def play(self, *_):
        """Walk on by itself, or stop."""
        (self.window.pause if self.window.playing else self.window.play)()

    def open(self, text):
        """Turn to what a link says."""
        if not isinstance(text, str):
            raise TracerError("link: not a text")
        self.window.open(links.parse(text))

    def take(self, tab, asked="", language=None):
        """A tab leads from now on; asked is the link in its address, language that of its browser."""
        if not (isinstance(tab, str) and 0 < len(tab) <= LONGEST_TAB):
            raise TracerError("tab: expected a short text")
        self.state.owner = tab
        if language is not None:
            self.speak(language)
        if asked and asked != self.state.link:
            self.open(asked)

    def speak(self, language):
        """Show everything in another language."""
        if language not in LANGUAGES:
            raise TracerError(
                f"language: {str(language)[:20]!r} is not known; choose one of {', '.join(LANGUAGES)}"
            )
        self.window.speak(language)

    def dismiss(self):
        """Take the message away."""
        self.state.message = ""

    def truth(self):
        """What the server knows, for tests: the place, and the record as `castray inspect` has it."""
        c = self.session.cursor
        return {
            "cursor": {"x": c.x, "y": c.y, "path": c.path, "event": c.event},
            "link": self.session.link.write(),
            "spp_done": self.session.spp_done,
            "spp": self.session.settings.spp,
            "record": self.session.record.as_dict(self.session.scene),
        }


def whole(name, value, end):
    """A whole number from outside in 0..end-1."""
    text = str(value).strip() if isinstance(value, (int, str)) and not isinstance(value, bool) else ""
    if not (text.isascii() and text.isdecimal() and len(text) <= MOST_DIGITS and int(text) < end):
        raise TracerError(f"{name}: {str(value)[:20]!r} is not a whole number from 0 to {end - 1}")
    return int(text)
