"""A scene inside a recording: what it was made from, and the meshes and pictures it names."""

import hashlib
import json
import shutil
from pathlib import Path

import numpy as np

from tracer.scene_file.load import load_dict
from tracer.settings import TracerError

FILE, FOLDER = "scene.json", "files"


def described(scene):
    """(what the scene was made from, its files under the names they get in the recording: {name: path}).

    A file is named by its content. (None, {}) for a scene that was made neither from a file nor from a dict.
    """
    if scene.definition.source is None:
        return None, {}
    description, folder = scene.definition.source
    files = {}
    plain = json.loads(json.dumps(description, default=_plain))
    return _renamed(plain, folder, files), files


def _plain(value):
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else str(value)


def _renamed(value, folder, files):
    """A description with its files' names those that they have in the recording."""
    if isinstance(value, list):
        return [_renamed(entry, folder, files) for entry in value]
    if not isinstance(value, dict):
        return value
    value = {word: _renamed(entry, folder, files) for word, entry in value.items()}
    if isinstance(value.get("filename"), str):
        path = (Path(folder) / value["filename"]).resolve()
        if path.suffix.lower() == ".gltf":  # names further files itself: it stays where it is
            return {**value, "filename": str(path)}
        digest = hashlib.sha256(path.read_bytes()).hexdigest()[:20]
        value["filename"] = f"{FOLDER}/{digest}{path.suffix.lower()}"
        files[value["filename"]] = path
    return value


def keep(folder, description, files):
    """Put a description and its files into a recording's folder."""
    (folder / FOLDER).mkdir(exist_ok=True)
    for name, path in files.items():
        shutil.copyfile(path, folder / name)
    (folder / FILE).write_text(json.dumps(description, indent=1), encoding="utf-8")


def restore(folder, name):
    """The Scene that a recording's folder holds. Raises TracerError."""
    try:
        description = json.loads((folder / FILE).read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError) as error:
        raise TracerError(f"{folder / FILE}: the recording's scene cannot be read: {error}") from None
    if description is None:
        raise TracerError(
            f"{folder}: its scene was made in Python and is not in the recording; pass it as scene"
        )
    try:
        return load_dict(description, name, folder)
    except TracerError as error:
        raise TracerError(f"{folder / FILE}: {error}") from None
