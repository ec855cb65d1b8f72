"""The command `castray diff`."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

import tracer
from tracer.picture import check_path
from tracer.settings import TracerError
from viewer.options import Json, print_json


def diff(
    a: Path,
    b: Path,
    /,
    *,
    output: Annotated[Path | None, Parameter(name=["-o", "--output"])] = None,
    alpha: float = 0.01,
    json: Json = False,
):
    """Compare two pictures: is their difference more than noise? Exit code 0 if they are the same, 1 if not.

    Two .exr of castray from different seeds are compared by a z-test; others by their error only.

    Parameters
    ----------
    a
        The picture to judge.
    b
        The reference.
    output
        Where a map goes, blue where a is darker, red where brighter: z of each pixel and Z around it, to +-5.
    alpha
        Chance that two right pictures are called different.
    """
    from tracer.testing import compare
    from viewer import diff as words

    if not 0.0 < alpha < 1.0:
        raise TracerError(f"alpha: {alpha} is not between 0 and 1")
    if output is not None:
        check_path(output)
    names = str(a), str(b)
    pictures = tracer.read(a), tracer.read(b)
    verdict = compare(*pictures, alpha, names)
    if output is not None:
        tracer.write(words.drawing(*pictures, verdict), output)
    if json:
        print_json(words.as_dict(verdict, names))
    else:
        print(*words.lines(verdict, names), sep="\n")
    return 0 if verdict.same else 1
