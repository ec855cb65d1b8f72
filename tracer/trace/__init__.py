"""Recordings: what happened to many paths, in columns.

`trace` has their form in memory, `gather` makes them; `recording` keeps them in a folder, `reading` reads it.
"""

from tracer.trace.gather import gather, parts
from tracer.trace.reading import read_parts, read_trace
from tracer.trace.recording import record
from tracer.trace.trace import Table, Trace, join

__all__ = ["Table", "Trace", "gather", "join", "parts", "read_parts", "read_trace", "record"]
