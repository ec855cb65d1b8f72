"""Triangle meshes from files, read by trimesh."""

import numpy as np

from tracer.settings import TracerError


def read(path, place):
    """Vertices (V, 3) float64 and faces (F, 3) of a mesh file. Raises TracerError naming the place."""
    import trimesh

    if not path.is_file():
        raise TracerError(f"{place}: there is no file {path}")
    try:
        # No processing: what the file says is what is checked and shown.
        mesh = trimesh.load_mesh(path, process=False, maintain_order=True)
        vertices, faces = np.asarray(mesh.vertices, np.float64), np.asarray(mesh.faces, np.int64)
    except Exception as error:  # trimesh raises whatever its parsers do
        raise TracerError(
            f"{place}: {path} cannot be read as a mesh: {type(error).__name__}: {error}"
        ) from None
    if vertices.ndim != 2 or vertices.shape[1:] != (3,) or faces.ndim != 2 or faces.shape[1:] != (3,):
        raise TracerError(f"{place}: {path} holds no triangles")
    return vertices, faces
