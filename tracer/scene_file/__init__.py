"""Scenes from files and dicts, in the words of Mitsuba 3."""

from tracer.scene_file.load import built_in_scenes, load, load_dict

__all__ = ["built_in_scenes", "load", "load_dict"]
