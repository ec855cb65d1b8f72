"""The values in Mitsuba's XML: numbers, colours, points and transforms, as load_dict spells them."""

import re

from tracer.scene_file.words import listed, near
from tracer.settings import TracerError


def steps(element):
    """The steps of a <transform>, in the order in which they are applied."""
    known = {
        "translate": _translate,
        "rotate": _rotate,
        "scale": _scale,
        "lookat": _look_at,
        "matrix": _matrix,
    }
    made = []
    for child in element.children:
        child.alone()
        if child.tag not in known:
            hint = near(child.tag, known)
            raise TracerError(f"{child.where}: <{child.tag}>: is no transform; {hint}known: {listed(known)}")
        made.append(known[child.tag](child))
    return made


def _translate(element):
    return {"translate": _axes(element, 0.0)}


def _scale(element):
    if set(element.attributes) == {"value"}:
        values = _numbers(element, "value")
        return {"scale": values[0] if len(values) == 1 else values}
    return {"scale": _axes(element, 1.0)}


def _rotate(element):
    angle = _number(element, "angle")
    attributes = {name: value for name, value in element.attributes.items() if name != "angle"}
    return {"rotate": _axes(element._replace(attributes=attributes), 0.0), "angle": angle}


def _look_at(element):
    element.only("origin", "target", "up")
    return {"look_at": {word: _numbers(element, word) for word in element.attributes}}


def _matrix(element):
    element.only("value")
    values = _numbers(element, "value")
    if len(values) == 9:
        rows = [[*values[3 * k : 3 * k + 3], 0.0] for k in range(3)] + [[0.0, 0.0, 0.0, 1.0]]
    elif len(values) == 16:
        rows = [values[4 * k : 4 * k + 4] for k in range(4)]
    else:
        raise TracerError(f"{element.where}: <matrix>: has {len(values)} numbers; it takes 16, or 9")
    return {"matrix": rows}


def _axes(element, default):
    """Three numbers from x, y and z, or from value."""
    if "value" in element.attributes:
        element.only("value")
        return _numbers(element, "value")
    element.only("x", "y", "z")
    return [_number(element, axis) if axis in element.attributes else default for axis in "xyz"]


def _number(element, name):
    values = _numbers(element, name)
    if len(values) != 1:
        raise TracerError(f"{element.where}: <{element.tag} {name}>: has {len(values)} numbers; it takes one")
    return values[0]


def _numbers(element, name):
    """The numbers of an attribute, between commas or spaces."""
    text = element.get(name)
    try:
        if "_" in text:  # Python's own spelling
            raise ValueError
        return [float(word) for word in re.split(r"[\s,]+", text.strip())]
    except ValueError:
        raise TracerError(f"{element.where}: <{element.tag} {name}>: {text[:60]!r} is not numbers") from None


def _simple(read):
    """A reader of elements <tag name="..." value="..."/>."""

    def reader(element):
        element.only("name", "value")
        element.alone()
        return read(element)

    return reader


def _integer(element):
    text = element.get("value").strip()
    if not re.fullmatch(r"[+-]?[0-9]{1,18}", text):
        raise TracerError(f"{element.where}: <integer>: {text[:60]!r} is not a whole number")
    return int(text)


def _boolean(element):
    text = element.get("value").strip().lower()
    if text not in ("true", "false"):
        raise TracerError(f"{element.where}: <boolean>: {text[:60]!r} is neither true nor false")
    return text == "true"


def _colour(element):
    values = _numbers(element, "value")
    return values[0] if len(values) == 1 else values


def _spectrum(element):
    if ":" in element.get("value"):
        raise TracerError(
            f"{element.where}: <spectrum>: values by wavelength are not supported; give one number, or <rgb>"
        )
    return _number(element, "value")


def _triple(element):
    element.alone()
    attributes = {name: value for name, value in element.attributes.items() if name != "name"}
    if "value" not in attributes:
        for axis in "xyz":
            element.get(axis)
    return _axes(element._replace(attributes=attributes), 0.0)


VALUES = {
    "float": _simple(lambda element: _number(element, "value")),
    "integer": _simple(_integer),
    "boolean": _simple(_boolean),
    "string": _simple(lambda element: element.get("value")),
    "rgb": _simple(_colour),
    "spectrum": _simple(_spectrum),
    "vector": _triple,
    "point": _triple,
}
