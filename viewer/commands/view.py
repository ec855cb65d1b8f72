"""The command `castray view`."""

from dataclasses import fields
from pathlib import Path
from typing import Annotated

from tracer.settings import TracerError
from viewer.link import is_link, place_in, split
from viewer.options import CheckOptions, PathOptions, Whole, check_engine, scene_of, settings_and_steps


def view(
    what: str | None = None,
    /,
    *,
    scene: str | None = None,
    lesson: Annotated[int | None, Whole] = None,
    port: Annotated[int | None, Whole] = None,
    browser: bool = True,
    compare: str | None = None,
    engine: str = "numpy",
    options: PathOptions | None = None,
):
    """Open the viewer: click a pixel, step through its paths. Prints its address.

    Parameters
    ----------
    what
        A scene file, the bare name of one that comes with castray (default: cornell_unit), a link from the
        viewer's address bar, a folder that castray render --record made (castray query names a place in it:
        DIR#x=..&y=..&path=..), or an .exr that castray render made: it is compared with what it is of. Or
        your own tracer (FILE.py, as of castray check: it runs again whenever you save it) or the log of one
        (FILE.jsonl), with --scene, and with a place as well: FILE#x=..&y=..&path=..&event=...
    scene
        The scene that your own tracer or log is of (of a tracer, default: cornell).
    lesson
        Open that lesson beside its scene, in place of a scene.
    port
        Where to listen on 127.0.0.1 (default: any free port).
    browser
        Open a browser where there is one.
    compare
        What the picture is compared with: a bug of the zoo, right (the tracer without a bug), a picture's
        file (such as your own), or a recording's folder.
    engine
        Who makes the picture: numpy; gl, on the graphics card (needs moderngl and OpenGL 4.1), and what it
        cannot do, such as a bug, by NumPy; or auto: gl where there is a graphics card. The paths that you
        pick are NumPy's: nearly all the same but for rounding.
    """
    from tracer.picture import is_picture
    from viewer import app as viewer_app
    from viewer.pictured import serve_picture
    from viewer.recorded import is_recording, serve_recording

    if port is not None and not 0 <= port <= 65535:
        raise TracerError(f"port: {port} is not between 0 and 65535")
    check_engine(engine)
    if lesson is not None:
        if any(said is not None for said in (what, options, compare, scene)):
            raise TracerError("view: a lesson has its own scene and settings; leave out yours")
        viewer_app.serve_lesson(lesson, port, browser, engine)
        return
    what = "cornell_unit" if what is None else what
    if not is_link(what) and split(what)[0].lower().endswith((".py", ".jsonl")):
        if engine != "numpy":
            raise TracerError(f"engine: is for castray's own pictures; {what} brings its own")
        _serve_own(what, scene, port, browser, compare, options)
        return
    if scene is not None:
        raise TracerError(f"scene: is for your own tracer, FILE.py, or its log, FILE.jsonl; {what} is none")
    if is_link(what):
        viewer_app.serve_link(what, port, browser, compare, engine)
        return
    if is_recording(what):
        if options is not None:
            raise TracerError(f"{what}: a recording has its own settings; leave out the path options")
        serve_recording(what, port, browser, compare, engine)
        return
    if is_picture(what):
        if options is not None:
            raise TracerError(f"{what}: a picture has its own settings; leave out the path options")
        serve_picture(what, port, browser, compare, engine)
        return
    settings, _ = settings_and_steps(options)
    viewer_app.serve(scene_of(what, options), settings, port, browser, against=compare, engine=engine)


def _serve_own(what, scene, port, browser, compare, options):
    """Open the viewer on a tracer in Python or on a log."""
    from viewer import app as viewer_app
    from viewer.checking.learner import settings_of
    from viewer.comparing.rival import known
    from viewer.opening.given import of_log

    file, place = place_in(what)
    if not Path(file).is_file():
        raise TracerError(f"{file}: there is no such file")
    if compare is not None and not known(compare):
        raise TracerError(f"compare: {file} is compared with right, or with a bug of the zoo")
    if file.lower().endswith(".jsonl"):
        if options is not None:
            raise TracerError(f"{file}: a log has its own settings; leave out the path options")
        viewer_app.serve_given(of_log(file, scene, at=place), port, browser, compare)
        return
    settings = settings_of(_of_own(file, options))
    viewer_app.serve_learner(file, scene or "cornell", settings, port, browser, compare, place)


def _of_own(file, options):
    """The path options, if they leave to the file what its own code decides. Raises TracerError."""
    left = {f.name for f in fields(CheckOptions)}
    for f in fields(PathOptions) if options is not None else ():
        if f.name not in left and getattr(options, f.name) != f.default:
            raise TracerError(f"{f.name}: is decided by the code of {file}; leave it out")
    return options
