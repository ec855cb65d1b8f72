"""The command `castray bugs`."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from viewer.options import Json, print_json


def bugs(
    bug_id: str | None = None,
    /,
    *,
    thumbnails: Annotated[Path | None, Parameter(name=["--thumbnails", "--pictures"])] = None,
    json: Json = False,
):
    """List the bug zoo: what each bug looks like, by family. With an id, say all about that one.

    Parameters
    ----------
    bug_id
        One bug of the zoo.
    thumbnails
        A folder for small pictures, ID.png: the wrong one to the left, the right one beside it.
    """
    from rich.console import Console

    from lessons.zoo import FAMILIES, of
    from viewer.words import Speaker
    from viewer.zoo import as_dict, draw, print_bug, print_bugs

    chosen = [of(bug_id)] if bug_id else [bug for family in FAMILIES.values() for bug in family]
    drawn = {} if thumbnails is None else draw(chosen, thumbnails)
    if json:
        print_json([as_dict(bug) for bug in chosen])
        return
    console = Console(highlight=False)
    if bug_id:
        print_bug(chosen[0], console)
    else:
        print_bugs(console)
    if thumbnails is not None:
        say = Speaker()
        console.print("\n" + say("told.drawn", n=len(drawn), folder=thumbnails))
        still = [bug.id for bug in chosen if bug.only_cost]
        if still:
            console.print(say("told.undrawn", bugs=say.listed(*still)))
