"""The laws that each event must keep by itself, what a number is made of before the number."""

from tracer.doctor.laws import (
    bounce,
    camera,
    chain,
    emission,
    ledger,
    light_points,
    light_terms,
    media,
    records,
    roulette,
    surface,
)

_FAMILIES = (
    records,
    camera,
    chain,
    surface,
    media,
    emission,
    light_points,
    light_terms,
    bounce,
    roulette,
    ledger,
)
_ORDER = (
    "camera-pixel", "camera-ray", "camera-start",
    "on-surface", "unit-normal", "normal", "shading-normal", "unit-light", "unit-direction",
    "chain", "escape-direction", "own-surface",
    "first-surface", "escape-free", "distance", "wo",
    "side", "depth",
    "transmittance", "light-transmittance",
    "emission", "environment",
    "light-point", "light-normal", "light-direction", "light-distance", "light-pick",
    "light-radiance", "light-pdf", "light-f", "light-cos", "light-pdf-bsdf", "light-visible", "light-due",
    "bounce-side", "bounce-mirror", "bounce-mirror-f", "bounce-mirror-pdf", "bounce-f", "bounce-cos",
    "bounce-pdf",
    "pdf-of-last-bounce", "pdf-of-light", "pdf-of-environment",
    "emission-weight", "environment-weight", "light-weight",
    "roulette-probability", "roulette-played", "roulette-survival", "roulette-weight", "dead",
    "throughput", "throughput-on-arrival", "bounce-before", "light-throughput",
    "emission-term", "environment-term", "light-term", "light-nothing",
    "absorbed", "end", "ledger",
    "domain", "finite",
)  # fmt: skip
_BY_ID = {rule.id: rule for family in _FAMILIES for rule in family.RULES}
LAWS = tuple(_BY_ID[name] for name in _ORDER)
