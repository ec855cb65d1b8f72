"""The command `castray view`."""

from typing import Annotated

import tracer
from tracer.settings import TracerError
from viewer.options import PathOptions, Whole, settings_and_steps


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
        A scene file, the bare name of one that comes with castray, or a link from the viewer's address bar.
    port
        Where to listen on 127.0.0.1 (default: any free port).
    browser
        Open a browser where there is one.
    """
    from viewer import app as viewer_app
    from viewer.link import is_link

    if port is not None and not 0 <= port <= 65535:
        raise TracerError(f"port: {port} is not between 0 and 65535")
    if is_link(scene):
        viewer_app.serve_link(scene, port, browser)
        return
    settings, _ = settings_and_steps(options)
    viewer_app.serve(tracer.load(scene), settings, port, browser)
