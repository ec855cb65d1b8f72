"""Settings that a log does not declare: those that its numbers show, and those that are free."""

import numpy as np

from tracer.settings import ANY_DEPTH

_UNIFORM = 0.5 / np.pi  # 1/sr


def read_off(read):
    """Settings {name: value} of what was Read that its numbers show."""
    found: dict[str, object] = {}
    q = _column(read, "roulette", "probability")
    q = q[np.isfinite(q)]
    if q.size and 0.0 < q[0] <= 1.0 and np.ptp(q) <= 4.0 * read.header.eps:
        found["roulette"] = f"{q[0]:.6g}"
    elif not q.size and read.header.options.get("roulette") is None:
        found |= {"roulette": "off", "max_depth": ANY_DEPTH}
    pdf = _column(read, "bounce", "pdf")
    if pdf.size and np.mean(np.abs(pdf - _UNIFORM) <= 1e-4) > 0.9:
        found["hemisphere"] = "uniform"
    if _column(read, "light", "pdf_area").size and not _column(read, "light", "pdf").size:
        found["light_sampling"] = "area"
    if "strategy" in read.header.options or _weighs(read):
        found["integrator"] = "path"
    return {name: value for name, value in found.items() if name not in read.header.options}


def free(read, shown):
    """Names of settings that are neither declared nor one number: any lawful one is in order, vertex by
    vertex. "size" is the picture's, "roulette-start" the depth from which on roulette is played, which no log
    declares. shown: what read_off found."""
    chosen = _column(read, "roulette", "probability").size > 0
    declared = "roulette" in shown or read.header.options.get("roulette") is not None
    sized = all(read.header.options.get(name) is not None for name in ("width", "height"))
    found = {"roulette-start"} | ({"roulette"} if chosen and not declared else set())
    return frozenset(found | (set() if sized else {"size"}))


def _weighs(read):
    """Whether some light is weighted: found both by light samples and by bounces."""
    w = np.concatenate([_column(read, kind, "w") for kind in ("hit", "light")])
    return bool(((w > 0.0) & (w < 1.0)).any())


def _column(read, kind, name):
    for key, full in ((kind, name), (None, f"{kind}.{name}")):
        if key in read.columns and full in read.columns[key].values:
            found = read.columns[key]
            return found.values[full][..., found.given[full]].astype(np.float64)
    return np.empty(0)
