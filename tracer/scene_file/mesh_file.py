"""Triangle meshes from files, read by trimesh."""

import io

import numpy as np

from tracer.scene_file.words import LARGEST, shown
from tracer.settings import TracerError
from tracer.shape import chart
from tracer.shape.mesh import check


def read(path, place, smooth):
    """Vertices (V, 3) float64, faces (F, 3), vertex normals (V, 3) and texture coordinates of the faces'
    corners (F, 3, 2); None for normals and coordinates where there are none.

    Coordinates come from OBJ and PLY only, as the file has them. smooth: True for normals in any case (made
    from the faces where the file has none), False for none, None for those the file has. Raises TracerError
    naming the place.
    """
    try:
        there = path.is_file()
    except OSError as error:  # a name that no file can have
        raise TracerError(f"{place}: {shown(str(path))}: {error.strerror or error}") from None
    if not there:
        raise TracerError(f"{place}: there is no file {path}")
    try:
        with np.errstate(invalid="ignore"):  # what is no number is found below
            vertices, faces, normals, uv = _read(path)
    except Exception as error:  # trimesh raises whatever its parsers do
        raise TracerError(
            f"{place}: {path} cannot be read as a mesh: {type(error).__name__}: {error}"
        ) from None
    if vertices.ndim != 2 or vertices.shape[1:] != (3,) or faces.ndim != 2 or faces.shape[1:] != (3,):
        raise TracerError(f"{place}: {path} holds no triangles")
    check(f"{place}: {path}", vertices, faces)
    far = np.abs(vertices).max()
    if far > LARGEST:
        raise TracerError(f"{place}: {path} reaches {far:g} from its origin; the limit is {LARGEST:g}")
    if smooth is False:
        normals = None
    else:
        normals = _made(vertices, faces) if smooth and normals is None else unit(normals)
    return vertices, faces, normals, uv


def _read(path):
    """What a file says, unprocessed: that is what is checked and shown."""
    import trimesh
    from trimesh.exchange.load import mesh_loaders

    kind = path.suffix.lower().lstrip(".")
    if kind not in ("obj", "ply"):  # their stored normals are lost in a Trimesh; the others are flat here
        mesh = trimesh.load_mesh(path, process=False)
        return np.asarray(mesh.vertices, np.float64), np.asarray(mesh.faces, np.int64), None, None
    data = path.read_bytes()
    # Vertices of an OBJ stay as they are numbered, unless faces may disagree about what belongs to one.
    split = kind == "obj" and (b"\nvt" in data or b"\nvn" in data)
    said = mesh_loaders[kind](
        io.BytesIO(data), file_type=kind, skip_materials=True, maintain_order=not split, fix_texture=False
    )
    parts = list(said["geometry"].values()) if "geometry" in said else [said]
    start = np.cumsum([0] + [len(part["vertices"]) for part in parts])
    vertices = np.concatenate([np.asarray(part["vertices"], np.float64) for part in parts])
    faces = np.concatenate(
        [np.asarray(part["faces"], np.int64) + k for part, k in zip(parts, start, strict=False)]
    )
    normals = [part.get("vertex_normals") for part in parts]
    whole = [
        n is not None and np.shape(n) == np.shape(p["vertices"]) for n, p in zip(normals, parts, strict=True)
    ]
    smooth = np.concatenate([np.asarray(n, np.float64) for n in normals]) if all(whole) else None
    corners = [_corners(part) for part in parts]
    uv = None if any(c is None for c in corners) else np.concatenate(corners)
    return vertices, faces, smooth, uv


def _corners(part):
    """Texture coordinates (F, 3, 2) of the corners of faces; None unless all have one that is of use."""
    uv = getattr(part.get("visual"), "uv", None)
    of_faces = "texcoord" in part.get("metadata", {}).get("_ply_raw", {}).get("face", {}).get(
        "properties", {}
    )
    if uv is None or of_faces or len(uv) != len(part["vertices"]):
        return None
    uv = np.asarray(uv, np.float64)[np.asarray(part["faces"], np.int64)][..., :2]
    return uv if (np.abs(uv) <= chart.LARGEST).all() else None


def unit(normals):
    """Normals of length 1; 0 for those that are none. None for None."""
    if normals is None:
        return None
    size = np.abs(normals).max(axis=1, keepdims=True)
    good = (size > 0.0) & (size < np.inf)
    scaled = np.where(good, normals, 0.0) / np.where(good, size, 1.0)
    return scaled / np.where(good, np.linalg.norm(scaled, axis=1, keepdims=True), 1.0)


def _made(vertices, faces):
    """Normals from the faces round each vertex, weighted by their angles there."""
    import trimesh

    return np.array(trimesh.Trimesh(vertices, faces, process=False).vertex_normals)
