"""What the doctor says of a picture: in words, as JSON, and as pictures side by side."""

import shlex

import numpy as np
from rich.console import Console
from rich.table import Table
from rich.text import Text

from lessons.course import about
from tracer.doctor import LAWS, statistics
from tracer.doctor.picture import FITS, predicted, strangest
from viewer.doctor_report import bug_title
from viewer.folded import Folded
from viewer.words import Speaker

_RULES = {rule.id: rule for rule in (*LAWS, *statistics.RULES)}
_WORTH = 0.5  # share of what is off that the nearest mistake explains, to be named
_ALWAYS = ("hit.p", "light.q", "direct")  # what a log has to say for the laws of light samples
_LOGGED = 3  # columns that are asked for, of each mistake


def log_of(hypothesis, album):
    """Columns "kind.field" that would prove the mistakes: what the law takes that each breaks first."""
    rules = (_RULES.get(album.rules.get(bug, "")) for bug in hypothesis.bugs)
    return tuple(dict.fromkeys(need for rule in rules if rule for need in rule.needs[:_LOGGED]))


def as_dict(opinion, picture, scene, album):
    """The JSON of `castray doctor PICTURE`: findings stays empty, since a picture proves nothing."""
    reading = opinion.reading
    read = {"curve": reading.curve, "turned": reading.turn, "shape": reading.shape}
    read |= {"likelier": opinion.likelier} if opinion.likelier is not None else {}
    return {
        "picture": str(picture),
        "scene": scene.name,
        "size": [reading.rgb.shape[1], reading.rgb.shape[0]],
        "read": read,
        "right": {"fits": opinion.is_right, "deviation": opinion.right.typical, "spp": opinion.right.spp},
        "invalid": opinion.invalid,
        "walls": [{"object": w.name, "ratio": _numbers(w.ratio), "share": w.share} for w in opinion.walls],
        "hypotheses": [_hypothesis(h, opinion, album) for h in opinion.hypotheses],
        "nearest": opinion.nearest and _hypothesis(opinion.nearest, opinion, album),
        "clues": opinion.clues and _clues(opinion.clues),
        "findings": [],
    }


def _clues(found):
    counts = ("agree", "straight", "around", "below")
    return {
        "objects": [
            {
                "object": seen.name,
                "says": seen.state,
                "direct": None if np.isnan(seen.direct) else seen.direct,
            }
            for seen in found.objects
        ],
        **{name: dict(zip(("places", "of"), getattr(found, name), strict=True)) for name in counts},
        "power": found.power,
        "of_material": found.of_material,
        "log": list(found.log),
    }


def _hypothesis(h, opinion, album):
    evidence = {
        wall.name: {"yours": _numbers(wall.ratio), "predicted": _numbers(_predicted(wall, h, opinion, album))}
        for wall in opinion.walls
    }
    return {
        "bugs": list(h.bugs),
        "alike": list(h.alike),
        "explains": h.explains,
        "deviation": h.deviation,
        "spp": h.spp,
        "factor": h.factor,
        "marks": dict(h.marks),
        "evidence": evidence,
        "log": list(log_of(h, album)),
        "lessons": [n for n in map(about, h.bugs) if n is not None],
    }


def _numbers(values):
    return None if values is None else [float(v) if np.isfinite(v) else None for v in values]


def _predicted(wall, h, opinion, album):
    known = album.rights[0].near(max(album.rights[0].at))
    return predicted(wall, h.looks, known, opinion.reading.eight_bits)


def print_opinion(opinion, picture, scene, album, guessed, console=None):
    """Hypotheses, and a table of the objects. scene: as it was asked for. guessed: whether the curve was not
    said."""
    console, say = console or Console(highlight=False), Speaker()
    console.width = min(console.width, 100)
    height, width = opinion.reading.rgb.shape[:2]
    console.print(
        Folded(Text(say("pic.head", picture=str(picture), width=width, height=height, scene=scene)))
    )
    for said in _how_read(opinion.reading, guessed, say):
        console.print(Folded(Text(said, style="yellow")))
    if opinion.likelier is not None:
        console.print(
            Folded(Text(say("pic.likelier", reading=_read_as(opinion.likelier, say)), style="yellow"))
        )
    console.print()
    if opinion.is_right:
        console.print(Folded(Text(say("pic.right"), style="bold green")))
        console.print(Folded(Text(say("pic.right_but"), style="dim")))
    elif not opinion.hypotheses:
        _print_nothing(opinion, scene, say, console)
    else:
        console.print(Folded(Text(say("pic.hypotheses"), style="bold yellow")))
        for h in opinion.hypotheses:
            console.print()
            _print_hypothesis(h, album, say, console)
    console.print()
    if opinion.clues is not None:
        print_objects(opinion.clues, say, console)
    else:
        _print_walls(opinion, album, say, console)
    console.print(Text(say("pic.beside", command=beside(picture, scene))), soft_wrap=True)


def beside(picture, scene):
    """The command that shows a picture beside the right one; scene: as it was asked for."""
    return f"castray view {shlex.quote(scene)} --compare {shlex.quote(str(picture))}"


def _how_read(reading, guessed, say):
    if reading.curve is not None:
        said = _read_as(reading.curve, say)
        odd = guessed and reading.curve != "srgb"
        yield f"{said} {say('pic.curve_guessed')}" if odd else said
    if reading.turn:
        yield say(f"pic.turn_{reading.turn}")
    if reading.shape:
        yield say(f"pic.shape_{reading.shape}")


def _read_as(curve, say):
    words = {"srgb": "pic.curve_srgb", 1.0: "pic.curve_none"}.get(curve, "pic.curve_gamma")
    return say(words, gamma=curve)


def _print_nothing(opinion, scene, say, console):
    console.print(Folded(Text(say("pic.nothing"), style="bold red")))
    for said in beyond(opinion, scene, say):
        console.print(Folded(Text(said)))
    near = opinion.nearest
    if near is not None and near.bugs and near.explains >= _WORTH:
        said = say("pic.nearest", bugs=" + ".join(near.bugs), explains=near.explains)
        console.print(Folded(Text(said, style="dim")))


def beyond(opinion, scene, say):
    """Lines on a picture that nothing in the catalogue fits: what stands out, what agrees and what that
    excludes, how the rest is off, and what to log next. scene: as it was asked for."""
    wall, coloured = strangest(opinion.walls)
    if wall is not None:
        ratio = dict(zip(("red", "green", "blue"), wall.ratio.tolist(), strict=True))
        key = "pic.strangest_colour" if coloured else "pic.strangest"
        yield say(key, name=wall.name, **ratio, ratio=float(np.mean(wall.ratio)))
    found = opinion.clues

    def count(name, numbers):
        return say(f"pic.clue_{name}", n=numbers[0], of=numbers[1])

    yield count("dim" if found.dim else "places", found.agree)
    if found.direct_is_right:
        yield count("straight", found.straight)
    if found.direct_is_dark:
        yield count("below", found.below)
    if found.around[1]:
        yield count("around", found.around)
    if found.power is not None:
        yield say(f"pic.clue_{'bright' if found.power < 1.0 else 'dark'}", power=found.power)
    elif found.of_material:
        yield say("pic.clue_material")
    elif (
        (worst := found.worst) is not None and opinion.reading.turn is None and opinion.reading.shape is None
    ):
        (low, low_at), (high, high_at) = worst.low, worst.high
        places = {"low_at": "{}, {}".format(*low_at), "high_at": "{}, {}".format(*high_at)}
        yield say("pic.clue_varies", name=worst.name, low=low, high=high, **places)
    least = say.listed(*(name for name in _ALWAYS if name not in found.log))
    yield say("pic.log_three", fields=say.listed(*found.log), least=least)
    pairs = ", ".join(f'"{name}", {name.rpartition(".")[2]}' for name in found.log)
    yield say("pic.log_how", pairs=pairs, scene=shlex.quote(scene))


def _print_hypothesis(h, album, say, console):
    for k, said in enumerate(said_of(h, album, say)):
        console.print(Folded(Text(said if k == 0 else f"  {said}", style="bold" if k == 0 else "")))


def said_of(h, album, say):
    """Lines on a hypothesis; the first names it."""
    if h.factor is not None:
        yield say("pic.factor_samples" if h.bugs else "pic.factor", factor=h.factor)
    elif h.bugs:
        yield say("pic.fits", bugs=" + ".join(h.bugs))
    for bug in h.bugs:
        yield f"{bug}  {bug_title(bug, say)}"
    if h.alike:
        yield say("pic.or", others=say.listed(*h.alike))
    for name, value in h.marks:
        yield say(f"pic.mark_{name}", value=value)
    if h.explains is not None:
        left = say("pic.left_noise" if h.deviation <= FITS else "pic.left_more")
        yield say("pic.explains", explains=h.explains, left=left, spp=round(h.spp))
    log = log_of(h, album)
    if log:
        yield say("pic.prove", fields=say.listed(*log))
    for bug in h.bugs:
        more = [f"castray bugs {bug}", *([f"castray lesson {about(bug)}"] if about(bug) is not None else [])]
        yield say("pic.more", commands=say.listed(*more))


def _print_walls(opinion, album, say, console):
    first = next((h for h in opinion.hypotheses if h.looks is not None), None)
    table = Table(box=None, pad_edge=False)
    table.add_column(say("pic.object"), no_wrap=True)
    table.add_column(say("pic.yours"), no_wrap=True)
    if first is not None:
        table.add_column(say("pic.predicted", bugs=" + ".join(first.bugs)))
    for wall in opinion.walls:
        row = [Text(wall.name), Text(_three(wall.ratio))]
        if first is not None:
            row.append(Text(_three(_predicted(wall, first, opinion, album))))
        table.add_row(*row)
    console.print(table)


def print_objects(found, say, console):
    """Each object of a picture that nothing fits: how far it is off, its share of direct light, and what that
    says."""
    table = Table(box=None, pad_edge=False)
    table.add_column(say("pic.object"), no_wrap=True)
    table.add_column(say("pic.yours"), no_wrap=True)
    table.add_column(say("pic.direct"), justify="right")
    table.add_column(say("pic.says"))
    for seen in found.objects:
        share = f"{seen.direct:.0%}" if np.isfinite(seen.direct) else ""
        ends = {"low": seen.low[0], "high": seen.high[0]} if seen.low else {}
        table.add_row(seen.name, _three(seen.ratio), share, say(f"pic.state_{seen.state}", **ends))
    console.print(table)


def _three(values):
    return "" if values is None else " ".join(f"{v:6.3g}" if np.isfinite(v) else "     -" for v in values)


def drawing(opinion, album):
    """The picture, the right one and their ratio side by side in linear RGB: grey where it is 1, blue where
    the picture is darker, red where it is brighter, full at eight times."""
    from tracer.doctor.picture import resampled
    from viewer.diff import colours

    right = np.asarray(album.picture)
    mine = resampled(np.nan_to_num(opinion.reading.rgb, posinf=0.0, neginf=0.0), *right.shape[:2])
    small = 0.01
    ratio = np.log2((mine.mean(axis=2) + small) / (right.mean(axis=2) + small)) / 3.0
    gap = np.ones((right.shape[0], 1, 3))
    whole = np.concatenate((mine, gap, right, gap, colours(ratio)), axis=1)
    larger = max(1, 320 // max(right.shape[:2]))
    return whole.repeat(larger, axis=0).repeat(larger, axis=1).astype(np.float32)
