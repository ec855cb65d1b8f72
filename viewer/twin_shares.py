"""Which share of a twin run's difference comes from which technique and depth, as a table that adds up."""

from pathlib import PurePath

import numpy as np
from rich.table import Table
from rich.text import Text

from tracer.twin.shares import Share
from viewer.numerals import luminance

_DEEP = 6  # depths from here on are one row of the table
_NAME = 14  # characters of a side's name in the head of a column
_ORDER = ("emission", "light sample", "environment", "film", "not finite", "rounding")
_SMALL = 5e-4  # share of the difference that is not worth a word
_SURE = 4.0  # standard errors


def print_shares(twin, names, say, console):
    """By technique and depth; rows add up to the last one."""
    told = twin.told
    console.print(Text(say("twin.made_of"), style="bold"))
    rows = table()
    rows.add_column(say("twin.by"), no_wrap=True)
    colours = (say(f"twin.{name}") for name in ("red", "green", "blue", "share"))
    for name in (say("twin.depth"), *short_names(names, say), *colours):
        rows.add_column(Text(name), justify="right", no_wrap=True)
    whole, decimals = _luminance(told.difference), decimals_of(s.difference for s in told.shares)
    for share in (*_merged(told.shares), Share("all", None, told.means, told.difference)):
        brought = [f"{float(v):+.{decimals}f}" for v in share.difference]
        if share.technique == "rounding" and not any(float(v) for v in brought):
            continue
        rows.add_row(
            say(f"twin.{share.technique}"),
            _depth(share.depth, say),
            *(f"{_luminance(mean):.{decimals}f}" for mean in share.means),
            *brought,
            _share(_luminance(share.difference) / whole) if whole else "",
            style="bold" if share.technique == "all" else None,
        )
    if twin.error is not None:
        rows.add_row(say("twin.error"), "", "", "", *(f"{v:.2g}" for v in twin.error), "", style="dim")
    console.print(rows)
    console.print(Text(_verdict(twin, say)))
    if told.left_out:
        console.print(Text(say("twin.left_out", count=told.left_out), style="yellow"))
    console.print()


def _merged(shares):
    """The shares by technique and depth, those of all deep vertices put together."""
    rows = {}
    for share in shares:
        depth = None if share.depth is None else min(share.depth, _DEEP)
        rows.setdefault((_ORDER.index(share.technique), -1 if depth is None else depth), []).append(share)
    for (technique, depth), members in sorted(rows.items()):
        means = tuple(_sum(share.means[which] for share in members) for which in range(2))
        difference = _sum(share.difference for share in members)
        yield Share(_ORDER[technique], None if depth < 0 else depth, means, difference)


def _sum(colours):
    return tuple(sum(channel) for channel in zip(*colours, strict=True))


def _depth(depth, say):
    if depth is None:
        return ""
    return str(depth) if depth < _DEEP else say("twin.from", depth=_DEEP)


def _verdict(twin, say):
    """By which technique the difference enters, and whether it is a bias."""
    whole, by = _luminance(twin.told.difference), dict.fromkeys(_ORDER[:-1], 0.0)
    for share in twin.told.shares:
        if share.technique in by:
            by[share.technique] += _luminance(share.difference)
    parts = [(way, v / whole) for way, v in by.items() if whole and abs(v / whole) > _SMALL]
    said = []
    if len(parts) > 1:
        listed = say.listed(*(f"{say(f'twin.{way}')} {_share(v)}" for way, v in parts))
        said.append(say("twin.ways", parts=listed))
    if twin.error is not None:
        sigma = max(
            abs(float(v)) / e if e > 0.0 else 0.0
            for v, e in zip(twin.told.difference, twin.error, strict=True)
        )
        said.append(say("twin.bias" if sigma >= _SURE else "twin.no_bias", times=f"{sigma:.3g}"))
    return say.sentences(*said)


def _luminance(colour):
    return luminance([float(v) for v in colour])


def _share(share):
    return f"{100.0 * share:.3g} %" if abs(share) > _SMALL else "0 %"


def table():
    """An empty table without lines."""
    return Table(box=None, pad_edge=False, padding=(0, 1, 0, 0))


def decimals_of(colours):
    """As many as show a thousandth of the largest value."""
    most = max((abs(float(v)) for colour in colours for v in colour), default=0.0)
    return 4 if most == 0.0 else int(np.clip(3 - np.floor(np.log10(most)), 0, 12))


def short_names(names, say):
    """Both sides' names as a column has room for them: of files without their folders, if these are alike."""
    files = tuple(PurePath(name).name for name in names)
    names = names if files[0] == files[1] else files
    cut = tuple(name if len(name) <= _NAME else "..." + name[3 - _NAME :] for name in names)
    return cut if cut[0] != cut[1] else (say("twin.first"), say("twin.second"))
