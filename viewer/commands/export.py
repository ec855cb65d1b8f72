"""The command `castray export`: a scene for Mitsuba 3."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

import tracer
from viewer.words import Speaker


def export(
    scene: str,
    /,
    *,
    output: Annotated[Path | None, Parameter(name=["-o", "--output"])] = None,
):
    """Write a scene as Mitsuba 3 XML, which castray and Mitsuba both read.

    Parameters
    ----------
    scene
        A scene file, or the bare name of one that comes with castray.
    output
        Where the XML goes; SCENE.xml in this folder unless said. Meshes stay where they are: those in or
        below its folder are named from there, others by their whole path.
    """
    loaded = tracer.load(scene)
    path = Path(f"{loaded.name}.xml") if output is None else output
    tracer.export(loaded, path)
    print(Speaker()("export.done", path=path))
