"""Rows of the tables that a shader reads."""

import numpy as np


def rows(count, ints, floats, more_ints=()):
    """A table of zeros with the named columns of four whole or four real numbers."""
    columns = [(ints, "4i4"), (floats, "4f4"), (more_ints, "4i4")]
    return np.zeros(count, [(name, kind) for names, kind in columns for name in names])
