"""Mitsuba 3 scene XML, translated into the nested dict that load_dict takes: meaning stays there.

What Mitsuba means by an element is kept even where a dict that says nothing would mean something else: a mesh
without normals is shaded smoothly. Integrators, samplers and filters are a matter of settings here; where
that could change the picture, a SceneWarning says so.
"""

import math
import re
import warnings

from tracer.scene_file.objects import kind_of
from tracer.scene_file.words import SceneWarning, listed, near
from tracer.scene_file.xml_tree import DEEPEST, Element, parse
from tracer.scene_file.xml_values import VALUES, steps
from tracer.settings import TracerError

OBJECTS = ("shape", "bsdf", "emitter", "sensor", "texture", "medium")
_SHARED = ("bsdf", "texture", "medium")  # what a <ref> may mean
_LONGEST = 4096  # characters of a parameter: parameters made of parameters would grow without bound
_PARAMETER = re.compile(r"\$([A-Za-z_]\w*)?")

# What is said about files, clipping, memory and sampling: nothing that castray draws depends on it.
_HARMLESS = {
    "film": {"file_format", "pixel_format", "component_format", "banner", "sample_border"},
    "sensor": {"near_clip", "far_clip"},
    "texture": {"format", "accel"},
    "medium": {"sample_emitters", "has_spectral_extinction"},
}


class Translation:
    """What a file says, as `description` for load_dict, and where it says it.

    path: the file; included files are looked for in its folder, or refused where it is to stand alone. Raises
    TracerError naming file and line.
    """

    def __init__(self, path, alone=False):
        self._alone = alone
        self._path, self._parameters, self._by_id, self._lines = path, {}, {}, {}
        self._settings = []
        root = parse(path)
        _check_root(root)
        self._root = self._substituted(root, 0)
        self._lines[""] = root.where
        self.description = self._scene()
        for where, text in self._settings:
            warnings.warn(f"{where}: {text}", SceneWarning, stacklevel=4)

    def place(self, message):
        """ "FILE: line N" for an error message of load_dict, which begins with the place in the dict."""
        fits = [p for p in self._lines if message.startswith(p) and message[len(p) : len(p) + 1] in ":.["]
        return self._lines[max(fits, key=len, default="")]

    def _substituted(self, element, files):
        """An element with its parameters and included files put in."""
        attributes = {name: self._text(element, value) for name, value in element.attributes.items()}
        whole = Element(element.tag, attributes, [], element.where)
        for child in element.children:
            if child.tag == "default":
                self._default(child)
            elif child.tag == "include":
                whole.children.extend(self._included(child, files))
            else:
                whole.children.append(self._substituted(child, files))
        name = attributes.get("id")
        if name is not None and element.tag != "ref":
            if name in self._by_id:
                raise TracerError(
                    f"{element.where}: id {name!r} is taken already ({self._by_id[name].where})"
                )
            self._by_id[name] = whole
        return whole

    def _text(self, element, value):
        def put(match):
            if match.group(1) not in self._parameters:
                known = listed(self._parameters) or "none"
                raise TracerError(f"{element.where}: {match.group()}: no such parameter; known: {known}")
            return self._parameters[match.group(1)]

        return _PARAMETER.sub(put, value)

    def _default(self, element):
        element.only("name", "value")
        element.alone()
        value = self._text(element, element.get("value"))
        if len(value) > _LONGEST:
            raise TracerError(f"{element.where}: a parameter of more than {_LONGEST} characters")
        self._parameters.setdefault(element.get("name"), value)

    def _included(self, element, files):
        element.only("filename")
        element.alone()
        if self._alone:
            raise TracerError(f"{element.where}: <include>: a scene from outside may name no file")
        if files >= DEEPEST:
            raise TracerError(f"{element.where}: <include>: files include one another too deeply")
        root = parse(self._path.parent / self._text(element, element.get("filename")))
        _check_root(root)
        return self._substituted(root, files + 1).children

    def _scene(self):
        scene = {"type": "scene"}
        for child in self._root.children:
            if child.tag == "integrator":
                self._integrator(child)
                continue
            if child.tag not in OBJECTS:
                raise _unknown(child, (*OBJECTS, "integrator", "default", "include"))
            place = child.attributes.get("id") or _free(
                child.attributes.get("type", child.tag), scene, self._by_id
            )
            if place == "type":
                raise TracerError(f"{child.where}: id 'type' is a word of its own; choose another id")
            if child.tag in ("texture", "medium"):  # stands where it is referred to
                continue
            scene[place] = self._object(child, place, ())
            self._check_family(child, scene[place], place)
        return scene

    def _check_family(self, element, table, place):
        try:
            family = kind_of(table, place)
        except TracerError as error:
            raise TracerError(f"{element.where}: {error}") from None
        if family != element.tag:
            raise TracerError(f"{element.where}: {table['type']!r} is a {family}, not a {element.tag}")

    def _object(self, element, place, above):
        """The table of an object. above: ids whose objects this one stands in."""
        element.only("type", "id", "name", "version")
        self._lines[place] = element.where
        table = {"type": element.get("type")}
        for child in element.children:
            said = self._entry(child, element, table, place, above)
            if said is None:
                continue
            word, value = said
            if word in table:
                raise TracerError(f"{child.where}: {place}.{word}: is given twice")
            table[word] = value
            self._lines.setdefault(f"{place}.{word}", child.where)
        if element.tag == "shape" and table["type"] in ("obj", "ply"):
            table.setdefault("face_normals", False)
        return table

    def _entry(self, child, element, table, place, above):
        """Word and value that a child adds to its object's table; None for what is a matter of settings."""
        tag = child.tag
        if tag in ("sampler", "rfilter"):
            self._setting(child)
            return None
        if tag in VALUES:
            word, value = child.get("name"), VALUES[tag](child)
            return None if word in _HARMLESS.get(element.tag, ()) else (word, value)
        if tag == "transform":
            child.only("name")
            word = child.get("name")
            self._lines.update({f"{place}.{word}[{k}]": step.where for k, step in enumerate(child.children)})
            made = steps(child)
            self._note_axes(child, made)
            return word, made
        if tag == "ref":
            return self._reference(child, element, table, place, above)
        if tag == "phase" and element.tag == "medium":  # what it says is for light that is scattered
            return None
        if tag in ("bsdf", "emitter", "film", "texture", "medium"):
            word = _word(child, element, table)
            return word, self._object(child, f"{place}.{word}", above)
        raise _unknown(child, (*VALUES, "transform", "ref", "bsdf", "emitter", "film", "texture", "medium"))

    def _note_axes(self, transform, made):
        for element, step in zip(transform.children, made, strict=True):
            size = math.hypot(*step.get("rotate", (1.0,)))
            if abs(size - 1.0) > 1e-6:
                text = f"rotate: an axis of length {size:.6g} shears in Mitsuba; here it is a direction only"
                self._settings.append((element.where, text))

    def _reference(self, child, element, table, place, above):
        """An object by its id: by name where load_dict knows the name, and as a copy elsewhere."""
        child.only("id", "name")
        child.alone()
        name = child.get("id")
        target = self._by_id.get(name)
        if target is None:
            hint = near(name, self._by_id)
            known = listed(self._by_id) or "none"
            raise TracerError(f"{child.where}: <ref>: no object has the id {name!r}; {hint}known: {known}")
        if target.tag not in _SHARED:
            raise TracerError(f"{child.where}: <ref>: {name!r} is a {target.tag}; known: {listed(_SHARED)}")
        if name in above:
            raise TracerError(f"{child.where}: <ref>: {name!r} is part of itself")
        word = _word(target._replace(attributes={**target.attributes, **child.attributes}), element, table)
        if element.tag == "shape" and word == "bsdf" and any(target is top for top in self._root.children):
            return word, name
        return word, self._object(target, f"{place}.{word}", (*above, name))

    def _setting(self, element):
        """A sampler changes no expected value; a filter other than the box does."""
        kind = element.get("type")
        if element.tag == "rfilter" and kind != "box":
            self._settings.append(
                (element.where, f"rfilter {kind!r} is not used: castray's pixels are boxes")
            )

    def _integrator(self, element):
        kind, said = element.get("type"), []
        if kind not in ("path", "direct", "volpath"):
            raise TracerError(
                f"{element.where}: integrator {kind!r} is not supported; known: path, direct, volpath"
            )
        if kind == "direct":
            said.append("--max-depth 2")
        for child in element.children:
            if child.tag not in VALUES:
                raise _unknown(child, VALUES)
            word, value = child.get("name"), VALUES[child.tag](child)
            if word == "max_depth" and value != -1:
                said.append(f"--max-depth {value}")
            if word == "hide_emitters" and value:
                raise TracerError(f"{child.where}: hide_emitters is not supported; take it out")
        if said:
            text = (
                f"integrator is a setting, not part of the scene; say {' '.join(said)} for the same picture"
            )
            self._settings.append((element.where, text))


def _check_root(root):
    if root.tag != "scene":
        raise TracerError(f'{root.where}: <{root.tag}>: a scene file begins with <scene version="3.0.0">')
    root.only("version", "id")
    version = root.get("version")
    if not re.fullmatch(r"[23]\.\d+\.\d+", version):
        raise TracerError(f"{root.where}: version {version!r} is not read; known: 2.0.0 up to Mitsuba 3")


def _word(child, element, table):
    """The word under which an object stands in the table of the one around it."""
    if child.tag in ("texture", "medium"):
        return child.get("name")
    if element.tag == "bsdf" and child.tag == "bsdf":  # a material of two may have one for each side
        return _free("bsdf", table, ())
    return child.tag


def _free(word, *taken):
    """The word, or with the first number after it that none has taken."""
    names, k = word, 1
    while any(names in those for those in taken):
        k += 1
        names = f"{word}_{k}"
    return names


def _unknown(element, known):
    hint = near(element.tag, known)
    return TracerError(
        f"{element.where}: <{element.tag}>: is not supported here; {hint}known: {listed(known)}"
    )
