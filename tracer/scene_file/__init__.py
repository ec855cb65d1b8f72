"""Scenes from files and dicts, in the words of Mitsuba 3."""

from tracer.scene_file.load import built_in_scenes, load, load_dict
from tracer.scene_file.words import SceneWarning

__all__ = ["SceneWarning", "built_in_scenes", "export", "load", "load_dict"]


def export(scene, path):
    """Write a scene as Mitsuba 3 XML (.xml); the file appears whole or not at all. Raises TracerError."""
    from tracer.scene_file.mitsuba_export import export as write

    write(scene, path)
