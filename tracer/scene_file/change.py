"""Some words of a scene said differently: what if the wall were darker, the glass denser, the lamp larger?

A change is written OBJECT.WORD=VALUE, in the words of scene files (white.reflectance=0.5,
lamp.emitter.radiance=[9,9,9], glass.int_ior=diamond). Beside these, any shape understands `scale`: a scaling
about its own origin, before its to_world (lamp.scale=2).
"""

import copy
import re

from tracer.scene import Scene
from tracer.scene_file.load import load_dict
from tracer.scene_file.objects import kind_of
from tracer.scene_file.words import listed, near, real, shown
from tracer.settings import TracerError

MOST, LONGEST = 32, 400  # changes at once, and characters of one
_KEY = re.compile(r"[^\s=.]+(\.[^\s=.]+)+")
_WORD = re.compile(r"[\w][\w .-]*")


def parse(texts):
    """Changes {key: value} from texts KEY=VALUE, of which the later ones win. Raises TracerError."""
    if len(texts) > MOST:
        raise TracerError(f"set: more than {MOST} changes")
    changes = {}
    for text in texts:
        key, equals, value = text.partition("=")
        key = key.strip()
        if not equals or len(text) > LONGEST or not _KEY.fullmatch(key):
            raise TracerError(
                f"set: {shown(text)} is no change; write OBJECT.WORD=VALUE, as in white.reflectance=0.5"
            )
        changes[key] = _value(key, value.strip())
    return changes


def _value(key, text):
    """What a text stands for: as a TOML file has it, several numbers with commas, or a plain word."""
    import tomllib

    for form in (text, f"[{text}]") if "," in text else (text,):
        try:
            return tomllib.loads(f"value = {form}")["value"]
        except (tomllib.TOMLDecodeError, RecursionError):
            continue
    if not _WORD.fullmatch(text):
        raise TracerError(f"set: {key}: {shown(text)} is neither a number, a list of numbers nor a word")
    return text


def written(changes):
    """The texts that parse reads as these changes."""
    return tuple(f"{key}={_text(value)}" for key, value in changes.items())


def _text(value):
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, (list, tuple)):
        return f"[{','.join(map(_text, value))}]"
    return f"{value!r}" if isinstance(value, (int, float)) else str(value)


def plain(changes):
    """The same changes, if a stranger may ask for them: numbers and words, and no names of files."""
    for key, value in changes.items():
        numbers = isinstance(value, list) and all(isinstance(v, (int, float)) for v in value)
        if key.rpartition(".")[2] == "filename" or not (numbers or isinstance(value, (int, float, str))):
            raise TracerError(f"set: {key}: a link may change numbers and words only")
    return changes


def changed(scene, changes):
    """The scene as it was loaded, with these changes {key: value} and no others. Raises TracerError."""
    definition = scene.definition
    source = definition.unchanged or definition.source
    if not changes and definition.unchanged is None:
        return scene
    if source is None:
        raise TracerError("set: a scene that was made in Python has no words to change")
    description, folder = copy.deepcopy(source[0]), source[1]
    for key, value in changes.items():
        _say(description, key, value)
    try:
        made = load_dict(description, definition.name, folder).definition
    except TracerError as error:
        raise TracerError(f"set: {error}") from None
    return Scene(made._replace(unchanged=source if changes else None, changes=dict(changes)))


def _say(description, key, value):
    """Put one change into a description."""
    name, *tables, word = key.split(".")
    if not isinstance(description.get(name), dict):
        objects = [known for known, said in description.items() if isinstance(said, dict)]
        raise TracerError(
            f"set: {key}: no {name!r} in this scene; {near(name, objects)}there are {listed(objects)}"
        )
    table = description[name]
    if word == "scale" and not tables and kind_of(table, name) == "shape":
        _scale(table, key, value)
        return
    for inner in tables:
        if not isinstance(table.get(inner), dict):
            raise TracerError(f"set: {key}: {inner!r} is no table there; it says {listed(table)}")
        table = table[inner]
    table[word] = value


def _scale(table, key, value):
    if real(value, f"set: {key}") <= 0.0:
        raise TracerError(f"set: {key}: {value:g} is not above 0")
    table["to_world"] = [{"scale": value}, *table.get("to_world", [])]
