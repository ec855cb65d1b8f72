"""Random Mitsuba files and meshes give a picture or one clear refusal (see test_fuzz_scenes)."""

import copy
import xml.etree.ElementTree as ElementTree

import pytest
from fuzzing import FUZZ, ROOM, edited, edits, likely, numbers, odd, picture_or_refusal
from hypothesis import given
from hypothesis import strategies as st

import tracer

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("fuzz")


@pytest.fixture(scope="module")
def as_xml(folder):
    """ROOM as Mitsuba XML."""
    tracer.export(tracer.load_dict(ROOM), folder / "room.xml")
    return (folder / "room.xml").read_text(encoding="utf-8")


@FUZZ
@given(edits)
def test_an_edited_xml_file(folder, as_xml, changes):
    (folder / "edited.xml").write_bytes(edited(as_xml, changes))
    picture_or_refusal(lambda: tracer.load(folder / "edited.xml"))


TAGS = (
    ["scene", "shape", "bsdf", "emitter", "sensor", "film", "texture", "medium", "transform", "rgb", "float"]
    + ["integer", "boolean", "string", "point", "vector", "translate", "scale", "rotate", "lookat", "matrix"]
    + ["ref", "default", "include", "sampler", "integrator", "spectrum", "path", "alias", "nonsense"]
)
ATTRIBUTES = ["type", "id", "name", "value", "x", "y", "z", "angle", "origin", "target", "up", "filename"]
cells = st.one_of(
    odd,
    st.sampled_from(["$spp", "$nothing", "$", "0.5", "1, 2, 3", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "true"]),
    st.lists(numbers, max_size=4).map(lambda row: " ".join(map(str, row))),
)
changes = st.lists(
    st.tuples(
        st.sampled_from(["tag", "name", "value", "value", "drop", "take", "copy", "move", "new"]),
        st.floats(0, 1),
        st.floats(0, 1),
        st.sampled_from(TAGS),
        st.sampled_from(ATTRIBUTES),
        cells,
    ),
    min_size=1,
    max_size=3,
)


def replanted(root, steps):
    """The tree with elements renamed, moved, copied, taken out or new, and attributes changed."""
    root = copy.deepcopy(root)
    for do, where, there, tag, attribute, value in steps:
        parents = {child: parent for parent in root.iter() for child in parent}
        everything = list(root.iter())
        at, to = (everything[round(share * (len(everything) - 1))] for share in (where, there))
        value = "".join(c for c in value if c.isprintable() and not 0xD800 <= ord(c) < 0xE000)
        if do == "tag":
            at.tag = tag
        elif do == "name" and at.attrib:
            at.set(attribute, at.attrib.pop(sorted(at.attrib)[0]))
        elif do == "value":
            at.set(sorted(at.attrib)[round(there * (len(at.attrib) - 1))] if at.attrib else attribute, value)
        elif do == "drop":
            at.attrib.clear()
        elif do == "new":
            ElementTree.SubElement(at, tag, {"name": attribute, "value": value})
        elif at in parents:
            if do in ("take", "move"):
                parents[at].remove(at)
            if do in ("copy", "move") and to not in at.iter():
                to.append(copy.deepcopy(at))
    return ElementTree.tostring(root)


@FUZZ
@given(changes)
def test_a_replanted_xml_tree(folder, as_xml, steps):
    root = ElementTree.fromstring(as_xml)
    (folder / "tree.xml").write_bytes(replanted(root, steps))
    picture_or_refusal(lambda: tracer.load(folder / "tree.xml"))


coordinates = st.one_of(st.floats(-1, 1), st.floats(-1, 1), numbers)


@FUZZ
@given(
    st.lists(st.tuples(*[coordinates] * 8), min_size=1, max_size=6),
    st.lists(st.tuples(*[st.one_of(st.integers(0, 3), st.integers(-2, 7))] * 3), max_size=6),
    st.sampled_from([None, True, False]),
    st.booleans(),
    st.booleans(),
    likely(1.0),
)
def test_a_mesh_of_any_numbers(folder, vertices, faces, flat, with_normals, with_uv, scale):
    words = (("x", "y", "z", "nx", "ny", "nz") if with_normals else ("x", "y", "z")) + ("u", "v") * with_uv
    head = f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\n"
    head += "".join(f"property double {word}\n" for word in words)
    head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    body = [" ".join(map(str, v[: len(words)])) for v in vertices] + [
        "3 " + " ".join(map(str, f)) for f in faces
    ]
    (folder / "any.ply").write_text(head + "\n".join(body) + "\n", encoding="utf-8")
    room = {**ROOM, "mesh": {"type": "ply", "filename": "any.ply", "to_world": [{"scale": scale}]}}
    if flat is not None:
        room["mesh"]["face_normals"] = flat
    if with_uv:
        room["mesh"]["bsdf"] = {"type": "diffuse", "reflectance": {"type": "ref", "id": "board"}}
    picture_or_refusal(lambda: tracer.load_dict(room, folder=folder))
