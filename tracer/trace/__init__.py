"""Recordings: what happened to many paths, in columns. `trace` has their form, `gather` makes them."""

from tracer.trace.gather import gather, parts
from tracer.trace.trace import Table, Trace, join

__all__ = ["Table", "Trace", "gather", "join", "parts"]
