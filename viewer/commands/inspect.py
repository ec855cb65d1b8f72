"""The command `castray inspect`."""

from typing import Annotated

from cyclopts import Parameter

import tracer
from tracer.settings import TracerError
from tracer.what_if import parse, supposed
from viewer.options import Json, PathOptions, Whole, print_json, scene_of, settings_and_steps, two_whole


def inspect(
    scene: str,
    /,
    *,
    pixel: Annotated[tuple[int, int], Parameter(converter=two_whole, n_tokens=2)],
    sample: Annotated[int | None, Whole] = None,
    what_if: Annotated[tuple[str, ...], Parameter(negative=())] = (),
    options: PathOptions | None = None,
    json: Json = False,
):
    """Show the events of a pixel's paths, and how their light adds up to the pixel.

    Parameters
    ----------
    scene
        A scene file, or the bare name of one that comes with castray.
    pixel
        Column and row, from 0 0 at the top left.
    sample
        Only this sample of the pixel (default: all; the brightest one is then shown event by event).
    what_if
        Show the sample as it would be: DEPTH.KIND=VALUE, as in 1.bounce=30,45 (degrees off the normal and
        about it), 0.light=0.2,0.3,0.9 (random numbers of the light sample), 4.roulette=survive (or stop).
    """
    settings, steps = settings_and_steps(options)
    loaded = scene_of(scene, options)
    if what_if:
        if sample is None:
            raise TracerError("what_if: is for one path; name its --sample")
        record = supposed(loaded, settings, *pixel, sample, parse(what_if), steps)
    else:
        record = tracer.inspect(loaded, settings, *pixel, sample, steps)
    prepared = loaded.at(record.settings)
    if json:
        print_json(record.as_dict(prepared))
        return
    from viewer.report import print_pixel

    print_pixel(record, prepared)
