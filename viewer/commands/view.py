"""The command `castray view`."""

from typing import Annotated

from tracer.settings import TracerError
from viewer.link import is_link
from viewer.options import PathOptions, Whole, scene_of, settings_and_steps


def view(
    scene: str = "cornell_unit",
    /,
    *,
    port: Annotated[int | None, Whole] = None,
    browser: bool = True,
    options: PathOptions | None = None,
):
    """Open the viewer: click a pixel, step through its paths. Prints its address.

    Parameters
    ----------
    scene
        A scene file, the bare name of one that comes with castray, a link from the viewer's address bar, or a
        folder that castray render --record made (castray query names a place in it: DIR#x=..&y=..&path=..).
    port
        Where to listen on 127.0.0.1 (default: any free port).
    browser
        Open a browser where there is one.
    """
    from viewer import app as viewer_app
    from viewer.recorded import is_recording, serve_recording

    if port is not None and not 0 <= port <= 65535:
        raise TracerError(f"port: {port} is not between 0 and 65535")
    if is_link(scene):
        viewer_app.serve_link(scene, port, browser)
        return
    if is_recording(scene):
        if options is not None:
            raise TracerError(f"{scene}: a recording has its own settings; leave out the path options")
        serve_recording(scene, port, browser)
        return
    settings, _ = settings_and_steps(options)
    viewer_app.serve(scene_of(scene, options), settings, port, browser)
