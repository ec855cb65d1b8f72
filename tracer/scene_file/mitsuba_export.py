"""A scene as Mitsuba 3 XML: what it was made from, word by word, so that reading it gives the same scene.

Meshes and pictures stay where they are: a file in or below the folder of the XML is named from there, any
other by its whole path. What Mitsuba would assume differently is said: the size of the film, its box filter,
whether a mesh is smooth, and that texels are kept in full. A rotation about an axis that is not of length 1,
which Mitsuba would take for a shear, goes out as its matrix.
"""

import re
import warnings
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from tracer.picture import write_whole
from tracer.scene_file.materials import BSDFS
from tracer.scene_file.objects import kind_of
from tracer.scene_file.textures import TEXTURES
from tracer.scene_file.to_world import to_world
from tracer.scene_file.words import SceneWarning
from tracer.settings import TracerError

_POINTS, _VECTORS = ("center", "position", "p0", "p1"), ("direction",)
_NOT_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def export(scene, path):
    """Write a scene as Mitsuba 3 XML; the file appears whole or not at all.

    Raises TracerError where that is impossible, or the scene was not made from a file or dict.
    """
    path = Path(path)
    if path.suffix.lower() != ".xml":
        raise TracerError(f"{path}: a Mitsuba scene is an .xml file; say -o {path.stem or 'scene'}.xml")
    text = _Writer(scene, path.parent).text()
    _warn_of_media(scene.definition)
    write_whole(path, lambda beside: Path(beside).write_text(text, encoding="utf-8"))


class _Writer:
    """Turns the description that a scene was made from into elements."""

    def __init__(self, scene, folder):
        if scene.definition.source is None:
            raise TracerError(
                f"{scene.name}: was not made from a scene file or dict, so it cannot be exported"
            )
        self.scene, self.folder = scene, folder.resolve()
        self.description, self.meshes = scene.definition.source

    def text(self):
        """The whole file."""
        root = ElementTree.Element("scene", version="3.0.0")
        tables = {name: table for name, table in self.description.items() if name != "type"}
        filled = any("interior" in table for table in tables.values())
        ElementTree.SubElement(root, "integrator", type="volpath" if filled else "path")
        kinds = {name: kind_of(table, name) for name, table in tables.items()}
        for family in ("sensor", *sorted(set(kinds.values()) - {"sensor", "shape"}), "shape"):
            for name, table in tables.items():
                if kinds[name] == family:
                    self.object(root, family, self.said(name, table, family), id=_text(name, name))
        ElementTree.indent(root)
        return '<?xml version="1.0" encoding="utf-8"?>\n' + ElementTree.tostring(root, "unicode") + "\n"

    def said(self, name, table, family):
        """A table with what Mitsuba would otherwise assume differently."""
        if family == "sensor":
            size = {"width": self.scene.width, "height": self.scene.height}
            return {**table, "film": {"type": "hdrfilm", **table.get("film", {}), **size}}
        if family != "shape" or "filename" not in table:
            return table
        if table["type"] not in ("obj", "ply"):
            raise TracerError(
                f"{name}.type: Mitsuba reads no {table['type']}; make an obj or ply of the mesh"
            )
        flat = [s.shape.normals is None for s in self.scene.definition.surfaces if s.shape.name == name]
        return {**table, "face_normals": flat[0]} if flat else table

    def object(self, parent, tag, table, **attributes):
        """An element with everything its table says."""
        element = ElementTree.SubElement(parent, tag, type=_text(table["type"], tag), **attributes)
        for word, value in table.items():
            if word != "type":
                self.entry(element, tag, word, value)
        if tag == "texture" and table["type"] == "bitmap":
            _value(element, "string", "format", "variant")  # or Mitsuba rounds the texels to half precision
        if tag == "film":
            ElementTree.SubElement(element, "rfilter", type="box")

    def entry(self, parent, tag, word, value):
        """One word of an object."""
        place = f"{parent.get('id', tag)}.{word}"
        if word in ("to_world", "to_uv"):
            _transform(ElementTree.SubElement(parent, "transform", name=word), value)
        elif word == "bsdf" and isinstance(value, str):
            ElementTree.SubElement(parent, "ref", id=_text(value, place))
        elif isinstance(value, dict):
            self.inside(parent, word, value, place)
        elif isinstance(value, bool):
            _value(parent, "boolean", word, str(value).lower())
        elif isinstance(value, str):
            text = self.file(value) if word == "filename" else value
            _value(parent, "string", word, _text(text, place))
        elif np.ndim(value) == 0:
            whole = tag == "film"
            _value(parent, "integer" if whole else "float", word, str(value) if whole else _number(value))
        elif word in (*_POINTS, *_VECTORS):
            kind = "point" if word in _POINTS else "vector"
            ElementTree.SubElement(
                parent, kind, name=word, **dict(zip("xyz", map(_number, value), strict=True))
            )
        else:
            _value(parent, "rgb", word, _numbers(value))

    def inside(self, parent, word, table, place):
        """A table within a table: a colour, a reference or another object."""
        kind = table.get("type", "hdrfilm")
        if kind == "rgb":
            _value(parent, "rgb", word, _numbers(np.ravel(table["value"])))
        elif kind == "ref":
            of_texture = self.description[table["id"]]["type"] in TEXTURES
            named = {"name": word} if of_texture else {}
            ElementTree.SubElement(parent, "ref", id=_text(table["id"], place), **named)
        elif word in ("film", "emitter"):
            self.object(parent, word, table)
        elif word == "interior":
            self.object(parent, "medium", _within_one(table), name=word)
        elif kind in BSDFS:
            self.object(parent, "bsdf", table)
        else:
            self.object(parent, "texture", table, name=word)

    def file(self, name):
        """Where a file of the scene is found from the folder of the XML."""
        whole = (self.meshes / name).resolve()
        return (whole.relative_to(self.folder) if whole.is_relative_to(self.folder) else whole).as_posix()


def _warn_of_media(definition):
    """A SceneWarning for what stands in coloured glass: castray sees it, Mitsuba has to be told."""
    media = definition.media
    if media is None:
        return
    said = "stands in a filled shape, which Mitsuba only knows if it is told (a medium"
    if media.camera:
        warnings.warn(f"the sensor {said} in the sensor)", SceneWarning, stacklevel=4)
    for surface, front, back in zip(definition.surfaces, media.front, media.back, strict=True):
        if (front if surface.shape.turned > 0 else back) > 0:
            warnings.warn(f"{surface.shape.name} {said} named exterior)", SceneWarning, stacklevel=4)


def _within_one(table):
    """A medium whose sigma_t, if it has colours, is at most 1, as Mitsuba wants it; scale holds the rest.

    Divided by a power of two, so that the product is the same number."""
    sigma_t = table.get("sigma_t", 1.0)
    sigma_t = np.array(sigma_t["value"] if isinstance(sigma_t, dict) else sigma_t, float)
    if sigma_t.ndim == 0 or sigma_t.max() <= 1.0:
        return table
    power = 2.0 ** np.ceil(np.log2(sigma_t.max()))
    return {**table, "sigma_t": sigma_t / power, "scale": power * table.get("scale", 1.0)}


def _transform(parent, value):
    if np.shape(value) == (4, 4):
        value = [{"matrix": value}]
    for step in value if isinstance(value, (list, tuple)) else [value]:
        if "look_at" in step:
            words = {word: _numbers(numbers) for word, numbers in step["look_at"].items()}
            ElementTree.SubElement(parent, "lookat", words)
        elif "matrix" in step:
            ElementTree.SubElement(parent, "matrix", value=_numbers(np.ravel(step["matrix"])))
        elif "rotate" in step and np.linalg.norm(step["rotate"]) != 1.0:
            matrix = to_world(step, "to_world")
            ElementTree.SubElement(parent, "matrix", value=_numbers(np.ravel(matrix)))
        elif "rotate" in step:
            axis = dict(zip("xyz", map(_number, step["rotate"]), strict=True))
            ElementTree.SubElement(parent, "rotate", axis, angle=_number(step["angle"]))
        else:
            ((word, numbers),) = step.items()
            ElementTree.SubElement(parent, word, value=_numbers(np.ravel(numbers)))


def _value(parent, tag, word, text):
    ElementTree.SubElement(parent, tag, name=word, value=text)


def _numbers(values):
    return " ".join(map(_number, values))


def _number(value):
    """The shortest text that reads as the same number."""
    return repr(float(value))


def _text(text, place):
    """The text itself, if XML and Mitsuba can carry it."""
    if _NOT_XML.search(text) or "$" in text:
        raise TracerError(f"{place}: {text!r} has a character that Mitsuba's XML cannot carry; rename it")
    return text
