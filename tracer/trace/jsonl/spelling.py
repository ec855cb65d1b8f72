"""Lines as JSON, numbers in any usual spelling."""

import json
import re
from itertools import chain

import numpy as np

# What printf and others make of numbers that are none, outside of strings.
_SPELLED = re.compile(r"(?<=[\[:,\s])([+-]?)(nan(?:\([^)]*\)|\w*)|inf(?:inity)?|1\.#\w+)(?=[\],}\s])", re.I)
_object = json.JSONDecoder().raw_decode
_WORDS = {
    "nan": np.nan, "-nan": np.nan, "inf": np.inf, "+inf": np.inf, "-inf": -np.inf,
    "infinity": np.inf, "+infinity": np.inf, "-infinity": -np.inf,
}  # fmt: skip


def decoded(raw):
    """(the object, "") of a line of bytes, or (None, what is wrong with it)."""
    try:
        text = raw.decode("utf-8")
        record, end = _object(text) if text[:1] == "{" else (json.loads(text), len(text))
        if text[end:].strip():
            return None, f"not JSON: more after the object, at column {end + 1}"
        return record, ""
    except UnicodeDecodeError:
        return None, "not UTF-8"
    except RecursionError:
        return None, "nested too deeply; give calls lines of their own"
    except json.JSONDecodeError as error:
        try:
            return json.loads(_SPELLED.sub(_json_number, raw.decode("utf-8"))), ""
        except (ValueError, RecursionError):
            return None, f"not JSON: {error.msg} at column {error.colno}"
    except ValueError as error:  # a whole number of thousands of digits
        return None, f"not JSON: {error}"


def _json_number(match):
    sign, word = match.groups()
    word = word.lower()
    if word.startswith("nan") or (word.startswith("1.#") and "inf" not in word):
        return "NaN"
    return f"{'-' if sign == '-' else ''}Infinity"


def plain_numbers(f, column):
    """The (..., N) array of a column of plain numbers; None where there is anything else."""
    if f.shape:
        if set(map(type, column)) != {list} or set(map(len, column)) != {f.shape[0]}:
            return None
        flat = list(chain.from_iterable(column))
    elif None in column:  # of a name it stands for none, of a number for NaN
        return None
    else:
        flat = column
    try:
        array = np.array(flat, np.float64)
    except (OverflowError, TypeError, ValueError):
        return None
    return array.reshape(-1, f.shape[0]).T if f.shape else array


def number(value):
    """The float that a decoded value stands for; ValueError if none."""
    if value is None:
        return np.nan
    if isinstance(value, str):
        found = _WORDS.get(value.strip().lower())
        if found is not None:
            return found
        if value.strip().lower().startswith(("nan", "-nan")):
            return np.nan
    elif isinstance(value, (int, float)):
        try:
            return float(value)
        except OverflowError:
            pass
    raise ValueError(f"{short(value)} is not a number")


def short(value):
    """A decoded value as a message shows it."""
    text = json.dumps(value, ensure_ascii=True)
    return text if len(text) <= 30 else f"{text[:27]}..."
