"""Memory that waves give back and ask for again a moment later stays with the process.

The C library returns large freed blocks to the system, and each page that comes back has to be cleared: a
fifth of the time of a large wave. Where it is glibc it can be told to keep them; elsewhere nothing is done.
"""

import sys
from functools import cache

_TRIM, _MMAP = -1, -3  # glibc's M_TRIM_THRESHOLD and M_MMAP_THRESHOLD
_KEPT = 1 << 28  # bytes: a wave's arrays are well below


@cache
def keep_freed():
    """Ask for it, once; whether it was granted."""
    if not sys.platform.startswith("linux"):
        return False
    import ctypes

    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    return mallopt is not None and bool(mallopt(_TRIM, _KEPT) and mallopt(_MMAP, _KEPT))
