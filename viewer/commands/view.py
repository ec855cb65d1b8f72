"""The command `castray view`."""

from typing import Annotated

from tracer.settings import TracerError
from viewer.link import is_link
from viewer.options import PathOptions, Whole, scene_of, settings_and_steps


def view(
    scene: str | None = None,
    /,
    *,
    lesson: Annotated[int | None, Whole] = None,
    port: Annotated[int | None, Whole] = None,
    browser: bool = True,
    compare: str | None = None,
    options: PathOptions | None = None,
):
    """Open the viewer: click a pixel, step through its paths. Prints its address.

    Parameters
    ----------
    scene
        A scene file, the bare name of one that comes with castray (default: cornell_unit), a link from the
        viewer's address bar, a folder that castray render --record made (castray query names a place in it:
        DIR#x=..&y=..&path=..), or an .exr that castray render made: it is compared with what it is of.
    lesson
        Open that lesson beside its scene, in place of a scene.
    port
        Where to listen on 127.0.0.1 (default: any free port).
    browser
        Open a browser where there is one.
    compare
        What the picture is compared with: a bug of the zoo, right (the tracer without a bug), a picture's
        file (such as your own), or a recording's folder.
    """
    from viewer import app as viewer_app
    from viewer.pictured import is_picture, serve_picture
    from viewer.recorded import is_recording, serve_recording

    if port is not None and not 0 <= port <= 65535:
        raise TracerError(f"port: {port} is not between 0 and 65535")
    if lesson is not None:
        if scene is not None or options is not None or compare is not None:
            raise TracerError("view: a lesson has its own scene and settings; leave out yours")
        viewer_app.serve_lesson(lesson, port, browser)
        return
    scene = "cornell_unit" if scene is None else scene
    if is_link(scene):
        viewer_app.serve_link(scene, port, browser, compare)
        return
    if is_recording(scene):
        if options is not None:
            raise TracerError(f"{scene}: a recording has its own settings; leave out the path options")
        serve_recording(scene, port, browser, compare)
        return
    if is_picture(scene):
        if options is not None:
            raise TracerError(f"{scene}: a picture has its own settings; leave out the path options")
        serve_picture(scene, port, browser, compare)
        return
    settings, _ = settings_and_steps(options)
    viewer_app.serve(scene_of(scene, options), settings, port, browser, against=compare)
