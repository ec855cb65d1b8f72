"""Asks a recording: a condition on its events, or one SELECT. It can change nothing and read nothing else.

Four walls, each enough for most of it: the statement has to be one SELECT that calls no function that reads
files; DuckDB may open the recording's own files only, its configuration is locked, no extension is loaded;
memory is limited; and all of it happens in a process of its own (see asker), which is ended when its time is
over (some functions of DuckDB neither count their memory nor listen).
"""

import json
import re
from difflib import get_close_matches
from importlib import import_module

from tracer.settings import TracerError
from tracer.trace import parquet, views

SECONDS = 60.0
MEMORY = 1 << 30  # bytes that DuckDB may use
ADDRESSES = 6 << 30  # bytes the process may ask the system for, where that can be limited
LONGEST = 10_000  # characters
TOO_LARGE = TracerError("query: needs too much memory; ask for less")
_READS = re.compile(
    r"read_|_scan|^glob$|parquet_|sniff_|^query|duckdb_|pragma_|^write_"
    r"|^getenv$|setting|logging|^which_secret$"
)

_WORD = re.compile(r"\s*(?:--[^\n]*\n\s*)*\(*\s*(select|with|from)\b", re.IGNORECASE)


class QueryError(TracerError):
    """What is wrong with a query, as one line, and taken apart for who shows it otherwise.

    words: what is wrong alone; at: which character of the query it is about, from 0, None where none is
    known; names: the columns there are.
    """

    def __init__(self, line, words="", at=None, names=()):
        super().__init__(line)
        self.words, self.at, self.names = words or line, at, tuple(names)


def check(text):
    """TracerError unless a text is short enough to be asked, and not empty."""
    if len(text) > LONGEST:
        raise TracerError(f"query: longer than {LONGEST} characters")
    if not text.strip():
        raise TracerError(
            "query: is empty; give a condition, such as 'depth >= 2 AND pdf < 1e-4', or a SELECT"
        )


def limit_memory():
    """Let this process ask the system for so much memory and no more, where that can be limited."""
    try:
        resource = import_module("resource")
        resource.setrlimit(resource.RLIMIT_AS, (ADDRESSES, ADDRESSES))
    except (ImportError, ValueError, OSError):  # not on every system
        return


def strangers(place, text):
    """What a query names in quotes that nothing in the recording is called: [(name, names that are near)]."""
    known = sorted({name for names in place.header["names"].values() for name in names})
    asked = dict.fromkeys(re.findall(r"'([^']*)'", text))
    return [(name, get_close_matches(name, known, 3, 0.5)) for name in asked if name not in known]


def answer(place, text, limit):
    """What the recording in the Folder `place` answers to a condition or a SELECT, in this process.

    As asker.ask, which does it in another one.
    """
    return answered(connection(place), place.level, text, limit)


def answered(connection, level, text, limit):
    """As answer, of a connection to a recording of that level."""
    import duckdb

    before = "" if _is_select(text) else f"SELECT 1 FROM {_view(level)} WHERE (\n"
    try:
        if not before:
            _check_select(connection, text)
            return _selected(connection, text, limit)
        _check_select(connection, f"{before}{text}\n)")
        connection.execute(f"{before}{text}\n) LIMIT 0")
        return _matches(connection, _view(level), text, limit)
    except duckdb.Error as error:
        raise _explained(error, text, len(before), level) from None


def _view(level):
    """What a condition is asked of."""
    return "events" if level == "events" else "paths"


def connection(place):
    """DuckDB with the recording's views and no way out."""
    import duckdb

    config = {
        "memory_limit": f"{MEMORY >> 20}MB",
        "temp_directory": "",
        "autoinstall_known_extensions": False,
    }
    opened = duckdb.connect(config=config | {"autoload_known_extensions": False})
    for name, value in (
        ("python_enable_replacements", "false"),
        ("preserve_insertion_order", "false"),
        ("errors_as_json", "true"),
        ("allowed_directories", f"[{parquet.literal(str(place.path.resolve()) + '/')}]"),
        ("enable_external_access", "false"),
    ):
        opened.execute(f"SET {name} = {value}")
    try:
        for statement in views.statements(place):
            opened.execute(statement)
    except duckdb.Error as error:
        raise TracerError(
            f"{place.path}: its parts are not those of a recording: {_said(error)[0]}"
        ) from None
    opened.execute("SET lock_configuration = true")
    return opened


def _is_select(text):
    """Whether a text is meant as a statement: it begins like a SELECT, or DuckDB reads it as one."""
    import duckdb

    if _WORD.match(text):
        return True
    try:
        return bool(duckdb.extract_statements(text))
    except duckdb.Error:
        return False


def _check_select(connection, text):
    """TracerError unless a text is one SELECT that reads from the views only."""
    import duckdb

    statements = connection.extract_statements(text)
    if len(statements) != 1:
        raise TracerError(f"query: has {len(statements)} statements; ask one SELECT at a time")
    if statements[0].type != duckdb.StatementType.SELECT:
        raise TracerError(f"query: is a {statements[0].type.name}; only a condition or a SELECT can be asked")
    _check_functions(connection, text)


def _check_functions(connection, text):
    """TracerError if a SELECT calls what reads files or settings, or what DuckDB cannot take apart."""
    (said,) = connection.execute("SELECT json_serialize_sql(?::VARCHAR)", [text]).fetchone()
    tree = json.loads(said)
    if tree.get("error"):
        raise TracerError(f"query: only a condition or a SELECT can be asked ({tree.get('error_message')})")
    for name in _functions(tree):
        if _READS.search(name.lower()):
            raise TracerError(f"query: {name} is not allowed; a query reads the views events and paths only")


def _functions(tree):
    """Names of all functions in a statement that was taken apart."""
    if isinstance(tree, dict):
        if isinstance(tree.get("function_name"), str):
            yield tree["function_name"]
        tree = list(tree.values())
    if isinstance(tree, list):
        for branch in tree:
            yield from _functions(branch)


def _selected(connection, text, limit):
    """The first rows of a SELECT."""
    result = connection.execute(text)
    columns = [column[0] for column in result.description]
    rows = result.fetchmany(limit + 1)
    return {
        "columns": columns,
        "rows": [[plain(v) for v in row] for row in rows[:limit]],
        "more": len(rows) > limit,
    }


def plain(value):
    """A value as JSON can hold it: null for NaN, "inf" for infinity."""
    if isinstance(value, float):
        if value != value:
            return None
        return value if abs(value) != float("inf") else ("inf" if value > 0 else "-inf")
    if isinstance(value, dict):
        return {str(key): plain(inner) for key, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(inner) for inner in value]
    return value if isinstance(value, (bool, int, str, type(None))) else str(value)


def _matches(connection, view, text, limit):
    """Paths with an event that a condition holds for; where there are paths only, those it holds for."""
    where = f"FROM {view} WHERE (\n{text}\n)"
    first = "min(step), arg_min(kind, step), arg_min(depth, step)" if view == "events" else "0, NULL, NULL"
    found = connection.execute(
        f"SELECT path, any_value(x), any_value(y), any_value(sample), count(*), {first} "
        f"{where} GROUP BY path ORDER BY path LIMIT {int(limit)}"
    ).fetchall()
    mask = connection.execute(
        f"SELECT x, y, count(DISTINCT path), count(*) {where} GROUP BY x, y ORDER BY y, x"
    ).fetchall()
    names = ("path", "x", "y", "sample", "events", "step", "kind", "depth")
    return {
        "events": sum(row[3] for row in mask),
        "paths": sum(row[2] for row in mask),
        "pixels": len(mask),
        "found": [dict(zip(names, row, strict=True)) for row in found],
        "mask": [list(row[:3]) for row in mask],
    }


def _said(error):
    """What DuckDB says: in words, where (None where it does not), and about which name."""
    text = str(error)
    begin = text.find("{")
    try:
        told = json.loads(text[begin:])
    except ValueError:
        return " ".join(text.split("\n\n")[0].split()), None, None
    words = _plainly(" ".join(told.get("exception_message", text).split("\n")[0].split()))
    position = told.get("position")
    return words, None if position is None else int(position), told.get("name")


def _plainly(words):
    """What DuckDB says most often, in words of those who do not know it."""
    said = re.sub(
        r'^Referenced column ("[^"]+") not found in FROM clause!?$', r"there is no column \1", words
    )
    said = re.sub(r"^\w+ Function with name (\S+) does not exist!?$", r"there is no function \1", said)
    return re.sub(r"^Table with name (\S+) does not exist!?$", r"there is no view \1", said)


def _explained(error, text, before, level):
    """The QueryError: what is wrong with a query, where, and the columns there are, the nearest first.

    before: how many characters stand before the text in what DuckDB was asked.
    """
    words, position, name = _said(error)
    if "memory" in words.lower():
        return QueryError(f"query: needs too much memory ({words}); ask for less")
    if name is None and (found := re.search(r'"([^"]+)"', words)):
        name = found.group(1)
    names = ("paths", "events")[: 1 + (level == "events")] if "no view" in words else views.names(level)
    nearest = [] if name in (*names, None) or "syntax" in words else get_close_matches(name, names, 3, 0.5)
    near = f"; did you mean {' or '.join(nearest)}?" if nearest else ";"
    if level == "paths" and name in views.names("events"):
        near = "; this recording has paths only (--record-level events keeps more);"
    at = _place(text, position, before, name)
    where = "" if at is None else f", at character {at + 1}: {' '.join(text[at : at + 20].split())!r}"
    line = f"query: {words}{where}{near} {'views' if 'no view' in words else 'columns'}: {', '.join(names)}"
    return QueryError(line, f"{words}{near}".rstrip(";"), at, names)


def _place(text, position, before, name):
    """Which character of a query is meant, from 0; None where that cannot be said."""
    offset = -1 if position is None else position - before
    if not 0 <= offset < len(text):
        offset = text.find(name) if name else len(text) - 1
    return offset if offset >= 0 else None
