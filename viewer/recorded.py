"""A recording in the viewer: its scene and settings, traced again where the reader looks."""

import sys
from pathlib import Path

import tracer
from lessons.zoo import planted
from tracer.trace import folder, reading
from tracer.trace.fingerprint import differences
from tracer.trace.stored_scene import restore
from viewer import link
from viewer.session import telling_pixel
from viewer.words import Speaker


def is_recording(text):
    """Whether a command line argument names the folder of a recording, with a place in it or without."""
    path = Path(text.partition("#")[0])
    return path.is_dir() and (text not in tracer.built_in_scenes() or (path / folder.HEADER).exists())


def serve_recording(text, port=None, open_browser=True, against=None, engine="numpy"):
    """Open the viewer on a recording, at the place named behind its # or where it has most to tell."""
    from viewer import app  # which itself looks at recordings

    name, _, words = text.partition("#")
    place = folder.whole(name)
    start = link.parse(f"scene=recorded&{words}").place if words else None
    scene = restore(place.path, place.header["scene"]["name"])
    if start is None:
        start = *telling_pixel(scene, place.settings), None, None
    said = compared(place, scene, *start[:2])
    if said:
        print(f"castray: {said}", file=sys.stderr)
    app.serve(scene, place.settings, port, open_browser, start, place, against=against, engine=engine)


def compared(place, scene, x, y):
    """What there is to say about a pixel that is traced again, None if it is the recorded one bit for bit and
    was recorded on a machine like this. Raises TracerError outside the picture."""
    settings = place.settings
    again = tracer.inspect(scene, settings, x, y, steps=planted(settings)).value
    stored = reading.stored_pixel(place, x, y)
    other = differences(place.header["fingerprint"])
    say = Speaker()
    told = {"x": x, "y": y, "other": say.listed(*map(say.error, other))}
    if again.tobytes() == stored.tobytes():
        return say("told.elsewhere_same", **told) if other else None
    told |= {"stored": _numbers(stored), "again": _numbers(again)}
    return say("told.elsewhere" if other else "told.other_state", **told)


def _numbers(values):
    return " ".join(str(v) for v in values)
