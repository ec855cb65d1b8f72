"""Scenes from TOML files and dicts, in the words of Mitsuba 3; mistakes are explained.

A scene is a table of named objects, each with a `type`. A transform is a list of steps in the order in
which they are applied. What is not supported is an error that names the place and the words that would do.
"""

import tomllib
from pathlib import Path

from tracer import scene_words as words
from tracer.scene import Definition, Scene, Surface
from tracer.settings import TracerError

BUILT_IN = Path(__file__).resolve().parents[1] / "scenes"


def built_in_scenes():
    """Names of the scenes that come with castray."""
    return tuple(sorted(file.stem for file in BUILT_IN.glob("*.toml")))


def load(scene):
    """A Scene from a file, or from the bare name of one that comes with castray.

    Raises TracerError with file, place, word, and the words that would do.
    """
    text = str(scene)
    path = Path(text)
    if path.suffix.lower() != ".toml":
        if text in built_in_scenes():
            path = BUILT_IN / f"{text}.toml"
        else:
            known = ", ".join(built_in_scenes())
            raise TracerError(f"{text}: no such scene; give a .toml file or one of {known}")
    try:
        source = path.read_text(encoding="utf-8")
        description = tomllib.loads(source)
    except OSError as error:
        raise TracerError(f"{path}: cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError as error:
        raise TracerError(f"{path}: is not a UTF-8 text file (byte {error.start})") from None
    except tomllib.TOMLDecodeError as error:
        raise TracerError(f"{path}: is not correct TOML: {error}") from None
    except RecursionError:
        raise TracerError(f"{path}: is nested too deeply to be a scene") from None
    try:
        return load_dict(description, path.stem, path.parent)
    except TracerError as error:
        raise TracerError(f"{path}: {error}") from None


def load_dict(description, name="scene", folder="."):
    """A Scene from nested dicts. folder: where mesh files are looked for. Raises TracerError."""
    if not isinstance(description, dict):
        raise TracerError("a scene is a table of named objects")
    objects = {key: value for key, value in description.items() if key != "type"}
    if description.get("type", "scene") != "scene":
        raise TracerError(f"type: {description['type']!r} at the top; a scene says \"scene\" or nothing there")
    kinds = {key: words.kind_of(value, key) for key, value in objects.items()}
    bsdfs = {key: words.bsdf(objects[key], key) for key, kind in kinds.items() if kind == "bsdf"}
    surfaces = tuple(
        _surface(words.Words(objects[key], key), bsdfs, Path(folder))
        for key, kind in kinds.items()
        if kind == "shape"
    )
    sensors = [key for key, kind in kinds.items() if kind == "sensor"]
    if len(sensors) != 1:
        raise TracerError(f"a scene has one sensor (type \"perspective\"); here are {len(sensors)}")
    if not surfaces:
        raise TracerError(f"no shapes; add one of type {words.listed(words.SHAPES)}")
    camera, width, height = words.sensor(objects[sensors[0]], sensors[0])
    used = {surface.bsdf: bsdfs[surface.bsdf] for surface in surfaces}
    return Scene(Definition(name, surfaces, used, camera, width, height))


def _surface(table, bsdfs, folder):
    """One shape with its material, which is added to `bsdfs` if it is written inside the shape."""
    shape = words.shape(table, folder)
    radiance = words.area_emitter(table.take("emitter", None), f"{table.place}.emitter")
    given = table.take("bsdf", None)
    table.finish()
    if given is None:
        bsdfs.setdefault("default", words.bsdf({"type": "diffuse"}, "default"))
        return Surface(shape, "default", radiance)
    if isinstance(given, dict) and given.get("type") == "ref":
        reference = words.Words(given, f"{table.place}.bsdf")
        given = reference.take("id")
        reference.take("type")
        reference.finish()
    if isinstance(given, dict):
        inline = f"{table.place}.bsdf"
        bsdfs[inline] = words.bsdf(given, inline)
        return Surface(shape, inline, radiance)
    if given not in bsdfs:
        raise TracerError(
            f"{table.place}.bsdf: no material {given!r} in this scene; there are {words.listed(bsdfs) or 'none'}"
        )
    return Surface(shape, given, radiance)


