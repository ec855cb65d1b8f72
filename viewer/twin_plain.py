"""What a twin run found, as plain values."""

import numpy as np

from tracer.recorder import number, plain


def as_dict(twin, sides):
    """Plain values, as `castray twin --json` prints them."""
    told = twin.told
    return {
        "names": list(twin.names),
        "same": twin.same,
        "pairs": twin.pairs,
        "alone": list(twin.alone),
        "differing": twin.differing,
        "rounded": twin.rounded,
        "causes": [
            {
                "kinds": list(c.kinds), "what": c.what, "pairs": c.pairs, "depths": c.depths, "also": c.also,
                "difference": _numbers(c.difference), "example": _parting(c.example, sides),
            }
            for c in twin.causes
        ],
        "shares": told and [
            {
                "technique": s.technique, "depth": s.depth, "means": [_numbers(m) for m in s.means],
                "difference": _numbers(s.difference),
            }
            for s in told.shares
        ],
        "means": told and [_numbers(mean) for mean in told.means],
        "difference": told and _numbers(told.difference),
        "error": _numbers(twin.error),
        "left_out": told and told.left_out,
        "largest": [_parting(p, sides) for p in twin.largest],
        "uncompared": [{"field": place, "only": twin.names[which]} for place, which in twin.uncompared],
        "notes": list(twin.notes),
    }  # fmt: skip


def _parting(parting, sides):
    numbers = {
        n.field.name: [
            plain(v[()], n.field, side.trace.scene) for v, side in zip(n.values, sides, strict=True)
        ]
        for n in parting.numbers
    }
    commands = [side.commands(parting.place(step)) for side, step in zip(sides, parting.steps, strict=True)]
    return {
        "x": parting.x, "y": parting.y, "sample": parting.sample, "kinds": list(parting.kinds),
        "steps": list(parting.steps), "depths": list(parting.depths), "what": parting.what,
        "numbers": numbers, "radiance": parting.radiance and [_numbers(v) for v in parting.radiance],
        "commands": commands,
    }  # fmt: skip


def _numbers(values):
    return None if values is None else [number(np.float64(v)) for v in values]
