"""Settings and scene in, picture or recording out."""

from tracer.engine.picture import Picture, inspect, render

__all__ = ["Picture", "inspect", "render"]
