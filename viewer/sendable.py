"""Plain values as JSON and every browser understand them: what is no number is nothing."""

import math


def sendable(values):
    """Dicts, lists, texts, numbers and bytes, with None for NaN and "inf" or "-inf" for infinity, as
    `tracer.recorder.number` has them in a recorded path."""
    if isinstance(values, dict):
        return {key: sendable(value) for key, value in values.items()}
    if isinstance(values, (list, tuple)):
        return [sendable(value) for value in values]
    if isinstance(values, float) and not math.isfinite(values):
        return None if math.isnan(values) else "inf" if values > 0 else "-inf"
    return values
