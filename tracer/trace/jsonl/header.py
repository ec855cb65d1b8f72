"""The first line of a log: who wrote it, how precisely, by which conventions and settings."""

from dataclasses import dataclass, fields

from tracer.settings import Settings, TracerError
from tracer.trace.jsonl.schema import CHOICES, HEADER, OPTIONS, UNITS, VERSION

_BITS = {32: 2.0**-23, 64: 2.0**-52}
_TYPES = {f.name: f.type for f in fields(Settings)}


@dataclass(frozen=True)
class Header:
    """What a log declares. unit: scene units per unit of the log, None where it has a name only."""

    tracer: str
    options: dict  # of Settings, as far as they are declared
    eps: float  # relative precision of the numbers
    bits: int
    unit: float | None
    unit_name: str
    turned: dict  # wi, wo, n, x, y -> one of CHOICES


def parsed(record, place):
    """The Header of a decoded first line; TracerError naming the field that is wrong."""
    if not isinstance(record, dict) or "castray" not in record:
        raise TracerError(
            f'{place}: no header; the first line has to be like {{"castray": {VERSION}, "tracer": "mine"}} '
            "(castray log --schema has all)"
        )
    if record["castray"] != VERSION:
        raise TracerError(
            f"{place}: format version {record['castray']!r:.20} is not known; this castray reads {VERSION}"
        )
    unknown = [name for name in record if name not in HEADER]
    if unknown:
        raise TracerError(f"{place}: {unknown[0]!r:.40} is not known; a header has {', '.join(HEADER)}")
    for name, choices in CHOICES.items():
        if record.get(name, choices[0]) not in choices:
            known = ", ".join(map(str, choices))
            raise TracerError(f"{place}: {name}: {record[name]!r:.20} is not known; choose one of {known}")
    digits, bits = record.get("digits", 9), record.get("bits", 32)
    if isinstance(digits, bool) or not isinstance(digits, int) or not 2 <= digits <= 17:
        raise TracerError(f"{place}: digits: {digits!r:.20} is not a whole number from 2 to 17")
    unit, name = _unit(record.get("unit", 1.0), place)
    turned = {key: record.get(key, choices[0]) for key, choices in CHOICES.items() if key != "bits"}
    options = {key: record[key] for key in OPTIONS if record.get(key) is not None}
    return Header(
        str(record.get("tracer", ""))[:80],
        _options(options, place),
        max(_BITS[bits], 0.5 * 10.0 ** (1 - digits)),
        bits,
        unit,
        name,
        turned,
    )


def _unit(unit, place):
    if unit in UNITS:
        return None, unit
    if isinstance(unit, (int, float)) and not isinstance(unit, bool) and 1e-9 <= unit <= 1e9:
        return float(unit), ""
    raise TracerError(f"{place}: unit: {unit!r:.20} is neither mm, cm, m nor a positive number")


def _options(options, place):
    if options.get("sampler") == "low-discrepancy":
        options["sampler"] = "lattice"
    if "roulette" in options:
        options["roulette"] = str(options["roulette"])
    for name, value in options.items():
        try:
            if name == "roulette" or (name == "strategy" and options.get("integrator", "path") == "path"):
                Settings(max_depth=1, **{name: value})
            elif name != "strategy":
                Settings(**{name: value})
        except TracerError as error:
            raise TracerError(f"{place}: {error}") from None
    return options


def settings_of(header, read_off):
    """The Settings of a log: declared ones, then those read off its numbers."""
    said = {"precision": header.bits, "integrator": "direct"} | read_off | header.options
    if said["integrator"] != "path":
        said.pop("strategy", None)
    return Settings(**said)
