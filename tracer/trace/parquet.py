"""Columns to Parquet files and back, by DuckDB."""

import threading
from contextlib import contextmanager

from tracer.settings import TracerError

# Measured on the columns of cornell_unit: SMALL needs the fewest bytes of what costs little time, QUICK the
# least time. Dictionaries pay for columns of few values; to look for larger ones takes longer than they save.
DICTIONARY = 2048  # values
SMALL = f"PARQUET_VERSION v2, COMPRESSION zstd, COMPRESSION_LEVEL 1, DICTIONARY_SIZE_LIMIT {DICTIONARY}"
QUICK = f"PARQUET_VERSION v2, COMPRESSION uncompressed, DICTIONARY_SIZE_LIMIT {DICTIONARY // 4}"
MEMORY = "400MB"  # a row group in the making is the most that is held


_own = threading.local()  # two threads cannot share a connection


def connection():
    """This thread's DuckDB, in memory, on one thread."""
    import duckdb

    if not hasattr(_own, "connection"):
        _own.connection = duckdb.connect(
            config={"threads": 1, "memory_limit": MEMORY, "autoinstall_known_extensions": False}
        )
    return _own.connection


def write(file, columns, options=SMALL, **notes):
    """Write {name: (E,)} to a file; notes: words kept in its footer. Raises TracerError."""
    more = ", ".join(f"{name}: {literal(str(value))}" for name, value in notes.items())
    metadata = f", KV_METADATA {{{more}}}" if notes else ""
    with explained(file):
        connection().register("columns_to_write", columns)
        try:
            connection().execute(
                f"COPY columns_to_write TO {literal(file)} (FORMAT parquet, {options}{metadata})"
            )
        finally:
            connection().unregister("columns_to_write")


def read(files, columns):
    """{name: (E,)} of the named columns of files, one after the other. Raises TracerError."""
    wanted = ", ".join(map(quoted, columns))
    with explained(files[0] if len(files) == 1 else files[0].parent.parent):
        return connection().execute(f"SELECT {wanted} FROM {source(files)}").fetchnumpy()


def notes(file):
    """The words kept in a file's footer."""
    with explained(file):
        rows = (
            connection()
            .execute(f"SELECT key, value FROM parquet_kv_metadata({literal(pattern(file))})")
            .fetchall()
        )
    return {bytes(key).decode(): bytes(value).decode() for key, value in rows}


def source(files):
    """The files as SQL reads them."""
    return f"read_parquet([{', '.join(literal(pattern(file)) for file in files)}])"


def pattern(file):
    """A file's name as a pattern that only this file fits."""
    return "".join(f"[{c}]" if c in "[*?" else c for c in str(file))


def literal(text):
    """A text as SQL spells it."""
    return "'" + str(text).replace("'", "''") + "'"


def quoted(name):
    """A name as SQL spells it."""
    return '"' + str(name).replace('"', '""') + '"'


@contextmanager
def explained(place):
    """DuckDB's complaints as one TracerError that names the place; and Ctrl-C as such, of which it makes a
    RuntimeError."""
    import duckdb

    try:
        yield
    except RuntimeError as error:
        if str(error) != "Query interrupted":
            raise
        raise KeyboardInterrupt from None
    except (duckdb.Error, OSError) as error:
        line = " ".join(str(error).split("\n\n")[0].split())
        raise TracerError(f"{place}: {line}") from None
