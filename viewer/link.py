"""The link that names a moment: scene, settings, pixel, path, event. It holds no key and can be passed on."""

from dataclasses import dataclass, field, fields
from pathlib import Path
from urllib.parse import parse_qsl, quote, urlencode, urlsplit

from lessons.zoo import ZOO
from tracer import what_if
from tracer.scene_file.change import parse as read_changes
from tracer.scene_file.change import plain, written
from tracer.settings import Settings, TracerError

RIGHT = "right"  # the tracer without a bug
PLACE = ("x", "y", "path", "event")
LONGEST = 4096
OTHERS = ("set", "what_if", "compare")  # the first two are several texts each
BETWEEN = ";"  # two of them
DEFAULTS = {f.name: f.default for f in fields(Settings)}
TEXTS = {f.name for f in fields(Settings) if f.type in (str, str | None)}


@dataclass(frozen=True)
class Link:
    """What a link says. place: x, y, path, event, or None where it names no pixel. changes: of the scene's
    words, {key: value}; what_if: suppositions about the path, {(depth, kind): value}; compare: the tracer
    that it is compared with, "right" or a bug's id."""

    scene: str
    settings: Settings
    place: tuple | None = None
    changes: dict = field(default_factory=dict)
    what_if: dict = field(default_factory=dict)
    compare: str = ""

    def write(self):
        """The part after the # of an address; options that have their default are left out."""
        said = {k: v for k, v in self.settings.as_dict().items() if v != DEFAULTS[k]}
        place = dict(zip(PLACE, self.place, strict=True)) if self.place else {}
        if self.changes:
            said["set"] = BETWEEN.join(written(self.changes))
        if self.what_if:
            place["what_if"] = BETWEEN.join(what_if.written(self.what_if))
        if self.compare:
            said["compare"] = self.compare
        return urlencode({"scene": self.scene, **said, **place}, quote_via=quote)


def of_moment(moment):
    """The Link to a moment of a lesson."""
    place = (moment.x, moment.y, moment.path, moment.event)
    return Link(moment.scene, Settings(**moment.settings), place, moment.changes)


def is_link(text):
    """Whether a command line argument is a link rather than the name of a scene or a file."""
    return text.startswith(("http://", "https://", "#scene=", "scene="))


def parse(text):
    """Read a link, the whole address or the part after its #. TracerError says in one line what is wrong."""
    if len(text) > LONGEST:
        raise TracerError(f"link: longer than {LONGEST} characters")
    try:
        fragment = urlsplit(text).fragment if "#" in text else text
        pairs = parse_qsl(fragment, strict_parsing=True, max_num_fields=32, encoding="utf-8", errors="strict")
    except ValueError:
        raise TracerError("link: expected an address that ends in #scene=NAME&x=..&y=..") from None
    words = dict(pairs)
    if len(words) != len(pairs):
        raise TracerError("link: says the same thing twice")
    unknown = sorted(words.keys() - {"scene", *OTHERS, *PLACE, *DEFAULTS})
    if unknown:
        raise TracerError(
            f"link: {unknown[0]!r} is not known; it may say scene, {', '.join((*PLACE, *DEFAULTS, *OTHERS))}"
        )
    if not words.get("scene"):
        raise TracerError("link: names no scene")
    settings = Settings(**{k: _setting(k, words[k]) for k in DEFAULTS.keys() & words.keys()})
    changes = plain(read_changes(words["set"].split(BETWEEN))) if "set" in words else {}
    place, supposed = _place(words), {}
    if "what_if" in words:
        if place is None:
            raise TracerError("link: what_if without x and y of the pixel")
        supposed = what_if.parse(words["what_if"].split(BETWEEN))
    return Link(words["scene"], settings, place, changes, supposed, _compared(words.get("compare", "")))


def split(what):
    """A file or folder, and what is said of a place in it behind a #, "" where nothing is."""
    name, mark, words = what.rpartition("#")
    return (name, words) if mark and not Path(what).exists() else (what, "")


def place_in(what):
    """A file or folder, and (x, y, path, event) in it where #x=..&y=..&path=..&event=.. follows, else None.
    Raises TracerError."""
    name, words = split(what)
    asked = parse(f"scene=of&{words}") if words else Link("of", Settings())
    if asked != Link("of", Settings(), asked.place):
        raise TracerError(f"link: behind {name}# only x, y, path and event are said")
    return name, asked.place


def _compared(name):
    """What a link may compare with: tracers only, no files."""
    if name and name != RIGHT and not all(bug in ZOO for bug in name.split(",")):
        raise TracerError(f"link: compare={name[:80]!r} is neither {RIGHT!r} nor a bug of the zoo")
    return name


def _setting(name, text):
    default = DEFAULTS[name]
    if isinstance(default, bool):
        if text not in ("True", "False"):
            raise TracerError(f"link: {name}={text!r} is neither True nor False")
        return text == "True"
    return text if name in TEXTS else _whole(name, text)


def _place(words):
    named = [k for k in PLACE if k in words]
    if not named:
        return None
    if "x" not in words or "y" not in words:
        lacking = " and ".join(k for k in ("x", "y") if k not in words)
        raise TracerError(f"link: {named[0]} without {lacking} of the pixel")
    place = tuple(_whole(k, words.get(k, "0")) for k in PLACE)
    if min(place) < 0:
        raise TracerError("link: x, y, path and event count from 0")
    return place


def _whole(name, text):
    digits = text.removeprefix("-")
    if not (digits.isascii() and digits.isdigit() and len(digits) <= 12):
        raise TracerError(f"link: {name}={text!r} is not a whole number")
    return int(text)
