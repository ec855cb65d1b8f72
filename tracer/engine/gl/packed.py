"""All tables of a scene in one array of words, four numbers each, and the functions that read them.

One array, since a driver need not take more than a few. Words, since any shader can read those: of a buffer
or of a picture.
"""

import numpy as np

_WORD = 16  # bytes
_READS = {"i4": ("whole", 1), "f4": ("reals", 1), "f8": ("exact", 2)}  # function, words of four numbers


class Packed:
    """The tables that have been added so far."""

    def __init__(self):
        self._parts, self._words = [], 0

    def add(self, name, type_, table):
        """Put a table in. Returns the GLSL function NAME_at(k), which reads row k.

        table: rows with fields of four numbers each, in the order of the struct `type_`; or for `vec4` (N, 4)
        float32; or for `float` or `int` (N,) float32 or int32.
        """
        begin, table = self._words, np.ascontiguousarray(table)
        self._append(table.tobytes() or bytes(_WORD))
        if table.dtype.names:
            reads, place = [], 0
            for field in table.dtype.names:
                read, words = _READS[table.dtype[field].base.str[1:]]
                reads.append(f"{read}(w + {place})")
                place += words
            row = f"int w = {begin} + {place} * k;\n    return {type_}({', '.join(reads)});"
        elif type_ == "vec4":
            row = f"return reals({begin} + k);"
        else:
            read = "reals" if type_ == "float" else "whole"
            row = f"return {read}({begin} + (k >> 2))[k & 3];"
        return f"{type_} {name}_at(int k)\n{{\n    {row}\n}}"

    def _append(self, data):
        data += bytes(-len(data) % _WORD)
        self._parts.append(data)
        self._words += len(data) // _WORD

    @property
    def size(self):
        """In bytes."""
        return _WORD * self._words

    def tobytes(self):
        """All of it."""
        return b"".join(self._parts)
