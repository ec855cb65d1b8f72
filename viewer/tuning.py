"""What can be changed while one looks: the knobs of a scene's materials and lights, and of the settings."""

import math
from dataclasses import dataclass, fields, replace

from lessons.zoo import FAMILIES
from tracer.bsdf.metals import METALS
from tracer.scene_file.materials import DEFAULT_ALPHA, INDICES
from tracer.scene_file.objects import kind_of
from tracer.scene_file.words import colour
from tracer.settings import Settings, TracerError
from viewer.numerals import css

DIGITS = 6  # significant ones of a changed number
# word: (default, least, most, step); the most of a light's radiance is a multiple of what the scene says
ALBEDO, INDEX, ROUGHNESS = (0.5, 0.0, 1.0, 0.01), (1.5, 1.0, 3.0, 0.01), (DEFAULT_ALPHA, 0.01, 1.0, 0.01)
SIZE = (1.0, 0.1, 4.0, 0.05)
BRIGHTER = 4.0
_OF_MATERIAL = {
    "diffuse": ("reflectance",),
    "plastic": ("diffuse_reflectance", "int_ior"),
    "roughplastic": ("diffuse_reflectance", "int_ior", "alpha"),
    "conductor": ("material",),
    "roughconductor": ("material", "alpha"),
    "dielectric": ("int_ior",),
    "thindielectric": ("int_ior",),
    "roughdielectric": ("int_ior", "alpha"),
}
_OF_EMITTER = {
    "point": "intensity", "directional": "irradiance", "constant": "radiance", "envmap": "scale"
}  # fmt: skip
TUNED = (
    "integrator", "strategy", "heuristic", "sampler", "spp", "max_depth", "roulette", "light_sampling",
    "hemisphere", "seed", "bug",
)  # fmt: skip


@dataclass(frozen=True)
class Knob:
    """One word of a scene with the range in which it is turned.

    key: OBJECT.WORD; meaning: which word of the table explains it; value: as it is now, a colour by its
    brightest channel; base: the colour whose hue it keeps. choices: names in place of a range.
    """

    key: str
    meaning: str
    value: object
    low: float = 0.0
    high: float = 1.0
    step: float = 0.01
    base: tuple = ()
    choices: tuple = ()

    def said(self, value):
        """What the scene is to say for a value from outside. Raises TracerError."""
        if self.choices:
            if value not in self.choices:
                known = ", ".join(self.choices)
                raise TracerError(f"{self.key}: {str(value)[:20]!r} is not known; choose one of {known}")
            return value
        number = real_from(self.key, value, self.low, self.high)
        if not self.base:
            return number
        most = max(self.base)
        return [_short(number * (c / most if most else 1.0)) for c in self.base]

    def shown(self):
        """Plain values for the page."""
        colour = css([self.value * c / (max(self.base) or 1.0) for c in self.base]) if self.base else ""
        names = ("key", "meaning", "value", "low", "high", "step")
        return {name: getattr(self, name) for name in names} | {"colour": colour}


def real_from(name, value, low, high):
    """A number from outside within limits. Raises TracerError."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if isinstance(value, bool) or not low <= number <= high:
        raise TracerError(f"{name}: {str(value)[:20]!r} is not between {low:g} and {high:g}")
    return _short(number)


def _short(number):
    return float(f"{number:.{DIGITS}g}")


def knobs(scene):
    """What can be turned in a scene, materials first; nothing in one that was made in Python."""
    definition = scene.definition
    if definition.source is None:
        return []
    now, first = definition.source[0], (definition.unchanged or definition.source)[0]
    found, used = [], _used(now)
    for name, table in now.items():
        kind = kind_of(table, name) if isinstance(table, dict) else ""
        if kind == "bsdf" and name in used:
            found += _material(name, table, first[name])
        elif kind == "shape" and isinstance(table.get("bsdf"), dict) and "type" in table["bsdf"]:
            found += _material(f"{name}.bsdf", table["bsdf"], first[name]["bsdf"])
    for name, table in now.items():
        kind = kind_of(table, name) if isinstance(table, dict) else ""
        if kind == "shape" and isinstance(table.get("emitter"), dict):
            found += _lamp(name, table, first[name], definition.changes)
        elif kind == "emitter":
            found += _emitter(name, table, first[name])
    return found


def _used(description):
    """Names of the materials that shapes ask for."""
    asked = (table.get("bsdf") for table in description.values() if isinstance(table, dict))
    names = (said.get("id") if isinstance(said, dict) else said for said in asked)
    return {name for name in names if isinstance(name, str)}


def _material(place, table, first):
    if table["type"] == "twosided":
        word = next(word for word, value in table.items() if isinstance(value, dict))
        known = table[word]["type"] in _OF_MATERIAL
        return _material(f"{place}.{word}", table[word], first[word]) if known else []
    found = []
    for word in _OF_MATERIAL.get(table["type"], ()):
        if word == "alpha":
            words = ("alpha_u", "alpha_v") if {"alpha_u", "alpha_v"} & table.keys() else ("alpha",)
            found += [
                _number(f"{place}.{w}", w.replace("alpha", "roughness"), table.get(w), *ROUGHNESS)
                for w in words
            ]
        elif word == "int_ior":
            value = table.get(word, "bk7")
            found.append(_number(f"{place}.{word}", "index", INDICES.get(value, value), *INDEX))
        elif word == "material":
            if not {"eta", "k"} & table.keys():
                choices = ("none", *METALS)
                found.append(Knob(f"{place}.{word}", "metal", table.get(word, "none"), choices=choices))
        else:
            said, before = table.get(word, ALBEDO[0]), first.get(word, ALBEDO[0])
            found += _colour(f"{place}.{word}", "albedo", said, before, *ALBEDO[1:])
    return found


def _number(key, meaning, value, default, low, high, step):
    value = default if value is None else float(value)
    return Knob(key, meaning, value, min(low, value), max(high, value), step)


def _colour(key, meaning, value, first, low, high, step):
    """A colour's knob; it keeps the hue, of a black one that which it had at first. None where a texture
    stands for it."""
    try:
        now, before = (tuple(float(c) for c in colour(said, key)) for said in (value, first))
    except TracerError:
        return []
    return [Knob(key, meaning, max(now), low, max(high, *now), step, now if any(now) else before)]


def _lamp(name, table, first, changes):
    key = f"{name}.emitter.radiance"
    found = _light(key, "radiance", table["emitter"].get("radiance"), first["emitter"].get("radiance"))
    if table["type"] == "sphere":
        radius = float(first.get("radius", 1.0))
        limits = (_short(radius * share) for share in SIZE[1:])
        return [*found, _number(f"{name}.radius", "size", table.get("radius"), radius, *limits)]
    return [*found, _number(f"{name}.scale", "size", changes.get(f"{name}.scale"), *SIZE)]


def _emitter(name, table, first):
    word = _OF_EMITTER[table["type"]]
    if word == "scale":
        return [_number(f"{name}.scale", "radiance", table.get(word), 1.0, 0.0, BRIGHTER, 0.05)]
    return _light(f"{name}.{word}", "radiance", table.get(word, 1.0), first.get(word, 1.0))


def _light(key, meaning, value, first):
    most = _short(BRIGHTER * (float(max(colour(first, key))) or 1.0))
    return _colour(key, meaning, value, first, 0.0, most, _short(most / 200))


def turned(scene, key, value):
    """The changes of a scene with one knob turned to a value from outside. Raises TracerError."""
    knob = next((knob for knob in knobs(scene) if knob.key == key), None)
    if knob is None:
        raise TracerError(f"change: {str(key)[:40]!r} cannot be changed here")
    return {**scene.definition.changes, key: knob.said(value)}


def tuned(settings, name, value):
    """Settings with one of TUNED changed to a value from outside. Raises TracerError."""
    if name not in TUNED:
        raise TracerError(f"change: {str(name)[:40]!r} cannot be changed here")
    declared = next(f for f in fields(Settings) if f.name == name)
    if declared.type is int:
        text = str(value).strip()
        digits = text.removeprefix("-")
        if isinstance(value, bool) or not (digits.isascii() and digits.isdigit() and len(digits) <= 12):
            raise TracerError(f"{name}: {text[:20]!r} is not a whole number")
        value = int(text)
    elif not isinstance(value, str):
        raise TracerError(f"{name}: {str(value)[:20]!r} is not a text")
    more: dict[str, object] = {}
    if name == "bug":
        value = value or None
    if name == "integrator" and value != "path":
        more["strategy"] = "mis"  # the only one that the others have
    if name in ("sampler", "spp"):
        more["replicates"] = 1
    return replace(settings, **{name: value}, **more)


def dials(settings):
    """Plain values of the settings that can be turned: name, value, choices or limits."""
    found = []
    for name in TUNED:
        declared = next(f for f in fields(Settings) if f.name == name)
        choices = list(map(str, declared.metadata["choices"] or ()))
        if name == "bug":
            choices = ["", *(bug.id for family in FAMILIES.values() for bug in family)]
        value = getattr(settings, name)
        if name == "bug" and value and value not in choices:
            choices.append(value)  # several, planted by the command
        found.append({"name": name, "value": "" if value is None else value, "choices": choices})
    return found
