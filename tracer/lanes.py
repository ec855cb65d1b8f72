"""Lanes of a wave: some of them picked out or written to, and for each one of two numbers.

NumPy's own `where`, `copysign` and checked `take` branch lane by lane. Where neighbouring lanes differ in the
answer, as they do in a wave, that costs several times what these cost; the numbers are the same, bit for bit.
"""

import numpy as np

_INTEGER = {np.dtype(np.float32): np.dtype(np.int32), np.dtype(np.float64): np.dtype(np.int64)}
_SIGN = {np.dtype(np.float32): np.int32(-(2**31)), np.dtype(np.float64): np.int64(-(2**63))}  # its bit


def gather(whole, lanes):
    """Lanes (K,) of whole (..., N), all of them within it: (..., K)."""
    return whole.take(lanes, axis=-1, mode="wrap")  # which asks no lane whether it is there


def put(whole, lanes, part):
    """Write part (K,) or (3, K) to some lanes of whole (N,) or (3, N): by rows, which NumPy does faster."""
    if whole.ndim == 1:
        whole[lanes] = part
        return
    for row, of_part in zip(whole, part, strict=True):
        row[lanes] = of_part


def choose(mask, these, others):
    """`these` where mask (N,) is set, `others` elsewhere: both (N,), of one real or integer type."""
    dtype = these.dtype
    these, others = (v.view(_INTEGER.get(dtype, dtype)) for v in (these, others))
    chosen = these ^ others
    chosen *= mask
    chosen ^= others
    return chosen.view(dtype)


def signed(size, of):
    """Numbers `size` (N,), not below 0, with the signs of numbers `of` (N,) of their type: copysign."""
    integer = _INTEGER[size.dtype]
    sign = of.view(integer) & _SIGN[size.dtype]
    sign |= size.view(integer)
    return sign.view(size.dtype)
