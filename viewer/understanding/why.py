"""Why is this pixel black, or what it is? Reasons in sentences, the first the nearest to a cause."""

import numpy as np

from viewer.numerals import luminance
from viewer.understanding import ends, redone, samples, unfit
from viewer.understanding.reasons import Reason, spelled
from viewer.understanding.waterfall import DEEP, FILM, KINDS, carried, waterfall

MOST = 9  # reasons beside the first sentences
ALONE = 0.5  # share of the pixel from which on one path is told
WORTH = 0.1  # share of the pixel from which on a bar is told
MAKERS = ("bounce", "roulette")  # of a throughput
GROWN = 4.0  # throughput from which on its growth is told


def why(record, scene, own=True):
    """The Reasons of a recorded pixel: what it is, what is strange about it, which parts it has, and more.

    own: whether castray traced it. Another tracer uses its random numbers and its rounding as it likes, and
    may leave things out: it is held to what it recorded only.
    """
    scene = scene.at(record.settings)
    ranked = [
        *unfit.reasons(record, scene, own),
        *(redone.reasons(record, scene) if own else ()),
        *_counted(record),
        *samples.reasons(record, scene),
        *ends.reasons(record, scene),
        *ends.met(record, scene),
        *ends.unsampled(record, scene),
        *_growth(record),
    ]
    ranked.sort(key=lambda reason: (-reason.strange, -reason.weight))
    ranked, strange = ranked[:MOST], sum(reason.strange for reason in ranked[:MOST])
    parts = [*_alone(record), *_parts(record)]
    return (*_summary(record), *ranked[:strange], *parts, *ranked[strange:])


def _summary(record):
    """What the pixel is, in a sentence or two."""
    yield from _invalid(record)
    dead, of = ends.dead(record), len(record.paths)
    last = (dead[0][0], len(dead[0][1].events) - 1) if dead else None
    if np.any(record.value < 0):
        yield Reason("negative", of, of, _least(record), {"least": float(np.min(record.value))})
    elif not np.any(record.value):
        yield Reason("black", of, of, last)
        return
    if dead:
        yield Reason("dead", len(dead), of, last)


def _least(record):
    """Where the least contribution is, (path, event); None where none was recorded."""
    given = [
        (luminance(event.values["contribution"]), k, event.step)
        for k, path in enumerate(record.paths)
        for event in path.events
        if "contribution" in event.values
    ]
    return min(given)[1:] if given else None


def _invalid(record):
    broken = [
        (k, event.step)
        for k, path in enumerate(record.paths)
        if path.end == "invalid"
        for event in path.events
        if any(
            np.any(~np.isfinite(event.values[name]))
            for name in ("beta", "contribution")
            if name in event.values
        )
    ]
    if broken:
        count = len({k for k, _ in broken})
        yield Reason("invalid", count, len(record.paths), broken[0])


def _counted(record):
    """Paths that count for something else than they carry."""
    for bar in waterfall(record):
        if bar.kind == FILM:
            path, step = bar.place
            if not np.isfinite(record.paths[path].radiance).all():
                continue  # it was not recorded
            if np.allclose(
                record.paths[path].radiance, carried(record.paths[path]), rtol=unfit.OFF, atol=0.0
            ):
                continue  # added up in another order
            counted = spelled(record.paths[path].radiance)
            values = {"carried": spelled(carried(record.paths[path])), "counted": counted}
            yield Reason("film", bar.events, len(record.paths), (path, step), values, float(bar.events))


def _alone(record):
    """The path that is most of the pixel by itself, and its largest event."""
    given = [luminance(path.radiance) for path in record.paths]
    total, k = sum(given), int(np.argmax(given))
    if len(given) < 3 or not given[k] > ALONE * total > 0:
        return
    giving = [e for e in record.paths[k].events if "contribution" in e.values]
    if not giving:  # a log may say what a path brings and not what of
        return
    most = max(giving, key=lambda e: luminance(e.values["contribution"]))
    values = {
        "share": f"{100.0 * given[k] / total:.3g}",
        "path": k,
        "kind": most.kind.name,
        "depth": most.depth,
    }
    yield Reason("alone", 1, len(given), (k, most.step), values)


def _parts(record):
    """The largest bars of the waterfall."""
    total = luminance(record.value)
    bars = [bar for bar in waterfall(record) if bar.kind in KINDS and bar.depth != DEEP]
    for bar in sorted(bars, key=lambda bar: -luminance([float(v) for v in bar.value]))[:2]:
        share = luminance([float(v) for v in bar.value]) / total if total > 0 else 0.0
        if share > WORTH:
            values = {"share": f"{100.0 * share:.3g}", "kind": bar.kind, "depth": bar.depth}
            yield Reason("part", bar.events, len(record.paths), bar.place, values)


def _growth(record):
    """The step that made most of the largest throughput."""
    beta, k = max((_largest(path), k) for k, path in enumerate(record.paths))
    if not GROWN < beta < np.inf:
        return
    steps, before = [], 1.0
    for event in record.paths[k].events:
        if event.kind.name in MAKERS:
            now = float(np.max(event.values["beta"]))
            steps.append((now / before if before > 0 else 0.0, event))
            before = now
            if now == beta:
                break
    times, event = max(steps, key=lambda step: step[0])
    values = {"beta": beta, "times": times, "depth": event.depth}
    yield Reason(f"growth.{event.kind.name}", 1, len(record.paths), (k, event.step), values, 1.0)


def _largest(path):
    """The largest throughput of a path."""
    made = (event.values["beta"] for event in path.events if event.kind.name in MAKERS)
    return max((float(np.max(beta)) for beta in made), default=0.0)
