"""The zoo of usual mistakes: as a list, one of them in full, and pictures of what they do."""

import numpy as np
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

import tracer
from lessons.course import about
from lessons.zoo import FAMILIES, RIGHT, alike
from tracer.settings import TracerError
from viewer.folded import Folded
from viewer.progress import watched
from viewer.words import Speaker

SIDE, SPP = 96, 16  # longer side of a thumbnail in pixels, and its samples
GAP = 2  # pixels of white between the wrong picture and the right one


def print_bugs(console):
    """Every family with its bugs: id, title, and how they look."""
    say = Speaker()
    for family, members in FAMILIES.items():
        table = Table(
            title=say.optional(f"family.{family}", family),
            title_justify="left",
            title_style="bold",
            box=None,
            show_header=False,
        )
        table.add_column(min_width=3, no_wrap=True, style="cyan")
        table.add_column()
        for bug in members:
            title, symptom = title_of(bug, say), symptom_of(bug, say)
            table.add_row(bug.id, f"{title}\n[dim]{symptom}[/dim]")
        console.print(table)
        console.print()
    console.print(say("bugs.more"))


def print_bug(bug, console):
    """All that the zoo knows of one bug."""
    say = Speaker()
    console.print(f"[bold cyan]{bug.id}[/] [bold]{title_of(bug, say)}[/]")
    others = sorted(alike(bug.id) - {bug.id})
    said = {
        "seen": symptom_of(bug, say),
        "wrong": wrong_of(bug, say),
        "law": say.optional(f"broken.{bug.law}", bug.law),
        "steps": say.listed(*bug.changes) or say("value.none"),
        "shows": bug.command,
        "alike": say.listed(*others),
        "here": say.optional(f"aside.{bug.id}", bug.note),
        "lesson": f"castray lesson {about(bug.id)}" if about(bug.id) else "",
    }
    table = Table(box=None, show_header=False)
    table.add_column(no_wrap=True, style="dim")
    table.add_column()
    for name, text in said.items():
        if text:
            table.add_row(say(f"bugs.{name}"), Folded(Text(text)))
    console.print(Padding(table, (0, 0, 0, 1)))


def title_of(bug, say):
    """What a bug is called in the speaker's language."""
    return say.optional(f"bug.{bug.id}", bug.title)


def wrong_of(bug, say):
    """The code that makes the mistake, in the reader's language."""
    return say.optional(f"code.{bug.id}", bug.wrong)


def symptom_of(bug, say):
    """How it looks, in the speaker's language."""
    return say.optional(f"symptom.{bug.id}", bug.symptom)


def as_dict(bug):
    """Plain values of a bug, as `castray bugs --json` prints them."""
    family = next(name for name, members in FAMILIES.items() if bug in members)
    texts = {
        name: getattr(bug, name) for name in ("id", "title", "symptom", "wrong", "law", "note", "command")
    }
    return texts | {
        "family": family,
        "steps": list(bug.changes),
        "scene": bug.scene,
        "integrator": bug.integrator,
        "settings": bug.settings,
        "only_cost": bug.only_cost,
        "alike": sorted(alike(bug.id)),
        "lesson": about(bug.id),
    }


def draw(chosen, folder):
    """Put pictures ID.png of the bugs that change one into a folder; {id: path}. Raises TracerError."""
    if not folder.is_dir():
        raise TracerError(f"{folder}: is not a folder; make it first")
    seen = [bug for bug in chosen if not bug.only_cost]
    drawn, right = {}, {}
    with watched(Speaker()("progress.rendering")) as progress:
        for done, bug in enumerate(seen):
            scene = tracer.load(bug.scene)
            scale = SIDE / max(scene.width, scene.height)
            width, height = (max(round(scale * side), 1) for side in (scene.width, scene.height))
            settings = bug.asked(width=width, height=height, spp=SPP)
            wrong = tracer.render(scene, settings, steps=bug.steps).rgb
            if (bug.scene, settings) not in right:
                right[bug.scene, settings] = tracer.render(scene, settings, steps=RIGHT).rgb
            gap = np.ones((height, GAP, 3), wrong.dtype)
            drawn[bug.id] = folder / f"{bug.id}.png"
            tracer.write(np.concatenate((wrong, gap, right[bug.scene, settings]), axis=1), drawn[bug.id])
            if progress:
                progress(done + 1, len(seen))
    return drawn
