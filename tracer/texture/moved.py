"""Where on a texture the points of a surface lie."""


def moved(to_uv, uv):
    """Coordinates uv (2, N) under to_uv (2, 3), as two (N,) of the same precision."""
    kind, (u, v) = uv.dtype.type, uv
    return [kind(a) * u + kind(b) * v + kind(c) for a, b, c in to_uv]
