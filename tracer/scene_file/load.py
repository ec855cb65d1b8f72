"""Scenes from TOML files, Mitsuba 3 XML and dicts, in the words of Mitsuba 3; mistakes are explained.

A scene is a table of named objects, each with a `type`. A transform is a list of steps in the order in
which they are applied. What is not supported is an error that names the place and the words that would do.
"""

import copy
from pathlib import Path

from tracer import medium
from tracer.definition import Definition, Surface
from tracer.scene import Scene
from tracer.scene_file import emitters, interior, limits, materials, objects
from tracer.scene_file.textures import Sources, texture
from tracer.scene_file.words import Words, listed, near, shown
from tracer.settings import TracerError
from tracer.shape import Mesh

BUILT_IN = Path(__file__).resolve().parents[2] / "scenes"


def built_in_scenes():
    """Names of the scenes that come with castray."""
    return tuple(sorted(file.stem for file in BUILT_IN.glob("*.toml")))


def load(scene, alone=False):
    """A Scene from a file, or from the bare name of one that comes with castray.

    alone: whether the file may name no others (meshes, pictures, parts of the scene), as one that came from
    outside. Raises TracerError with file, place, word, and the words that would do.
    """
    text = str(scene)
    path = Path(text)
    if path.suffix.lower() == ".xml":
        return _load_xml(path, alone)
    if path.suffix.lower() != ".toml":
        if text not in built_in_scenes():
            known, close = ", ".join(built_in_scenes()), near(text, built_in_scenes())
            raise TracerError(f"{text}: no such scene; {close}give a .toml or .xml file or one of {known}")
        path = BUILT_IN / f"{text}.toml"
    description = _toml(path)
    try:
        _check_alone(description, alone)
        return load_dict(description, path.stem, path.parent)
    except TracerError as error:
        raise TracerError(f"{path}: {error}") from None


def _load_xml(path, alone):
    from tracer.scene_file.mitsuba_xml import Translation

    xml = Translation(path, alone)
    try:
        _check_alone(xml.description, alone)
        return load_dict(xml.description, path.stem, path.parent)
    except TracerError as error:
        raise TracerError(f"{xml.place(str(error))}: {error}") from None


def _check_alone(description, alone):
    """TracerError for a description that names a file, where it may not."""
    left = [description] if alone else []
    while left:
        value = left.pop()
        if isinstance(value, dict) and "filename" in value:
            raise TracerError(f"filename: {shown(value['filename'])}: a scene from outside may name no file")
        left += value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()


def _toml(path):
    """The tables of a TOML file."""
    import tomllib

    try:
        return tomllib.loads(path.read_text(encoding="utf-8-sig"))  # some editors put a mark first
    except OSError as error:
        raise TracerError(f"{path}: cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError as error:
        raise TracerError(f"{path}: is not a UTF-8 text file (byte {error.start})") from None
    except tomllib.TOMLDecodeError as error:
        raise TracerError(f"{path}: is not correct TOML: {error}") from None
    except RecursionError:
        raise TracerError(f"{path}: is nested too deeply to be a scene") from None


def load_dict(description, name="scene", folder="."):
    """A Scene from nested dicts. folder: where mesh files are looked for. Raises TracerError."""
    if not isinstance(description, dict):
        raise TracerError("a scene is a table of named objects")
    named = {key: value for key, value in description.items() if key != "type"}
    if description.get("type", "scene") != "scene":
        raise TracerError(
            f'type: {shown(description["type"])} at the top; a scene says "scene" or nothing there'
        )
    kinds = {key: objects.kind_of(value, key) for key, value in named.items()}
    described = {key: named[key] for key, kind in kinds.items() if kind == "bsdf"}
    sources = Sources(described, {}, Path(folder))
    for key, kind in kinds.items():
        if kind == "texture":
            sources.textures[key] = texture(named[key], key, sources)
    bsdfs = _Bsdfs(sources)
    for key, table in described.items():
        bsdfs.read(key, table)
    surfaces = tuple(
        _surface(Words(named[key], key), bsdfs) for key, kind in kinds.items() if kind == "shape"
    )
    key = _only_sensor(kinds)
    if not surfaces:
        raise TracerError(f"no shapes; add one of type {listed(objects.SHAPES)}")
    camera, width, height = objects.sensor(named[key], key)
    limits.check(surfaces, camera)
    surfaces, media = _visible(surfaces, bsdfs, medium.around(surfaces, bsdfs, camera.origin))
    for surface in surfaces:
        _check_coordinates(surface, bsdfs)
    used = {surface.bsdf: bsdfs[surface.bsdf] for surface in surfaces}
    lights = (
        emitters.emitter(named[key], key, Path(folder)) for key, kind in kinds.items() if kind == "emitter"
    )
    lights = emitters.only_one_sky(tuple(lights))
    source = copy.deepcopy(description), Path(folder)
    return Scene(
        Definition(name, surfaces, used, camera, width, height, source, lights, media, bsdfs.textures)
    )


def _only_sensor(kinds):
    """Name of the sensor; TracerError unless there is one."""
    sensors = [key for key, kind in kinds.items() if kind == "sensor"]
    if len(sensors) != 1:
        raise TracerError(
            f'a scene has one sensor (type "perspective" or "thinlens"); here are {len(sensors)}'
        )
    return sensors[0]


class _Bsdfs(dict):
    """Materials by name, and the textures that stand for their parameters."""

    def __init__(self, sources):
        super().__init__()
        self.sources, self.textures = sources, {}

    def read(self, name, description):
        """Add a material."""
        self[name], self.textures[name] = materials.textured(description, name, self.sources)


def _surface(table, bsdfs):
    """One shape with its material, which is added to `bsdfs` if it is written inside the shape."""
    shape = objects.shape(table, bsdfs.sources.folder)
    radiance = emitters.area_emitter(table.take("emitter", None), f"{table.place}.emitter")
    given, filling = table.take("bsdf", None), table.take("interior", None)
    interior.refuse_exterior(table)
    table.finish()
    bsdf = _bsdf_of(given, table.place, bsdfs, radiance)
    inside = interior.interior(filling, f"{table.place}.interior", shape, bsdfs[bsdf])
    return Surface(shape, bsdf, radiance, inside)


def _bsdf_of(given, place, bsdfs, radiance):
    """Name of the material that a shape asks for."""
    if given is None:
        # As in Mitsuba: grey, but a lamp about which nothing is said is black.
        name, grey = ("default", 0.5) if radiance is None else ("default_lamp", 0.0)
        if name not in bsdfs:
            bsdfs.read(name, {"type": "diffuse", "reflectance": grey})
        return name
    if isinstance(given, dict) and given.get("type") == "ref":
        reference = Words(given, f"{place}.bsdf")
        given = reference.take("id")
        reference.take("type")
        reference.finish()
    if isinstance(given, dict):
        inline = f"{place}.bsdf"
        bsdfs.read(inline, given)
        return inline
    if not isinstance(given, str) or given not in bsdfs:
        known = listed(bsdfs) or "none"
        raise TracerError(f"{place}.bsdf: no material {shown(given)} in this scene; there are {known}")
    return given


def _check_coordinates(surface, bsdfs):
    """TracerError if a material needs coordinates (u, v) that a mesh does not have."""
    shape, textures = surface.shape, bsdfs.textures[surface.bsdf]
    if not isinstance(shape, Mesh) or shape.uv is not None:
        return
    if textures or bsdfs[surface.bsdf].anisotropic:
        what = "a texture" if textures else "a grain (alpha_u is not alpha_v)"
        raise TracerError(
            f"{shape.name}.bsdf: has {what}, but the mesh has no texture coordinates that say where it lies; "
            "use an OBJ with vt at all corners, or a PLY with u, v"
        )


def _visible(surfaces, bsdfs, media):
    """The surfaces and media without those that light passes as if they were not there (an index of 1, no
    colour, the same medium on both sides); all of them if nothing else were left."""
    kept = [
        k
        for k, s in enumerate(surfaces)
        if s.radiance is not None or not bsdfs[s.bsdf].vanishes or (media and media.bounding[k])
    ]
    if not kept:
        return surfaces, media
    return tuple(surfaces[k] for k in kept), media and media.of_shapes(kept)
