"""Logs of other tracers: JSON Lines, one call of a recursive function or one event a line.

`schema` says what a line may hold, `lines` reads it into `content`, `conventions` turns it into castray's
own, `calls` and `told` make events of calls; `castray.h` writes such a log from C++.
"""

from pathlib import Path

from tracer.trace.jsonl.reading import Log, read_log
from tracer.trace.jsonl.schema import schema_text

__all__ = ["Log", "header_file", "read_log", "schema_text"]


def header_file():
    """Path of castray.h."""
    return Path(__file__).with_name("castray.h")
