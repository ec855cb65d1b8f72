"""A picture of castray's in the viewer: the scene and the settings that its header names, traced again."""

import tracer
from tracer.settings import Settings, TracerError
from viewer import app


def serve_picture(text, port=None, open_browser=True, against=None, engine="numpy"):
    """Open the viewer on what a picture is of, beside the picture itself or what else is to be compared with.
    Raises TracerError for a picture that does not say what it is of."""
    notes = tracer.read(text).notes
    try:
        name, settings = notes["scene"], Settings(**notes["settings"])
    except (KeyError, TypeError):
        raise TracerError(
            f"{text}: does not say of which scene it is, as an .exr of castray render does; "
            f"castray view SCENE --compare {text} puts it beside its scene"
        ) from None
    app.serve(tracer.load(name), settings, port, open_browser, against=against or text, engine=engine)
