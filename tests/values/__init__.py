"""What castray makes of the values in truth.json, by subject."""

from values import boundaries, facets, lights, numbers, rooms
from values.registry import EVALUATORS, Estimate, estimate, evaluated, number

__all__ = [
    "EVALUATORS",
    "Estimate",
    "boundaries",
    "estimate",
    "evaluated",
    "facets",
    "lights",
    "number",
    "numbers",
    "rooms",
]
