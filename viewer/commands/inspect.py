"""The command `castray inspect`."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

import tracer
from tracer.picture import check_place, write_whole
from tracer.settings import TracerError
from tracer.what_if import parse, supposed
from viewer.options import Json, PathOptions, Whole, print_json, scene_of, settings_and_steps, two_whole


def inspect(
    scene: str,
    /,
    *,
    pixel: Annotated[tuple[int, int], Parameter(converter=two_whole, n_tokens=2, negative=())],
    sample: Annotated[int | None, Whole] = None,
    what_if: Annotated[tuple[str, ...], Parameter(negative=(), show_default=False)] = (),
    why: Annotated[bool, Parameter(negative=())] = False,
    html: Path | None = None,
    event: Annotated[int | None, Whole] = None,
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
    why
        Say instead why the pixel is black, or what it is: reasons in sentences, the nearest to a cause first,
        and what it is made of by depth and technique; with --json both beside the rest.
    html
        Where the paths in 3D go, too: one page that opens without a network.
    event
        Look instead at the vertex of this event of the --sample: its vectors, where bounces from there go
        against their density, the terms behind f, and both ends of its ray to the ulp.
    """
    if html is not None:
        check_place(html)
    settings, steps = settings_and_steps(options)
    loaded = scene_of(scene, options)
    if event is not None and (sample is None or why):
        raise TracerError("event: is one of a path; name its --sample, and leave out --why")
    if what_if:
        if why:
            raise TracerError("why: is about paths as they are; leave out --what-if")
        if sample is None:
            raise TracerError("what_if: is for one path; name its --sample")
        record = supposed(loaded, settings, *pixel, sample, parse(what_if), steps)
    else:
        record = tracer.inspect(loaded, settings, *pixel, sample, steps)
    prepared = loaded.at(record.settings)
    if html is not None:
        _write(html, record, loaded)
    if event is not None:
        _look(record, prepared, steps, event, json)
        return
    if json:
        print_json(record.as_dict(prepared) | (_reasons(record, prepared) if why else {}))
        return
    from viewer.report import print_pixel, print_why

    (print_why if why else print_pixel)(record, prepared)


def _write(file, record, scene):
    """The pixel's paths in 3D as a page, opened at the brightest."""
    from viewer.cursor import Cursor
    from viewer.offline import page
    from viewer.session import brightest, most_giving
    from viewer.words import Speaker

    path = brightest(record)
    lengths = tuple(len(one.events) for one in record.paths)
    cursor = Cursor(record.x, record.y, lengths, path, most_giving(record.paths[path]))
    text = page(scene, record, cursor, Speaker())
    write_whole(file, lambda beside: Path(beside).write_text(text, encoding="utf-8"))


def _look(record, scene, steps, event, json):
    """The vertex of an event under the lens, and its ray under the microscope."""
    from viewer.understanding import lens, microscope

    events = len(record.paths[0].events)
    if not 0 <= event < events:
        raise TracerError(f"event {event} is not there: events of this sample go from 0 to {events - 1}")
    seen, ends = lens.over(scene, steps, record, 0, event), microscope.ends(scene, record, 0, event)
    if seen is None:
        raise TracerError(f"event {event} is before the first surface; look at a later one")
    if json:
        print_json({"event": event, "lens": seen.as_dict(), "ends": ends and ends.as_dict(scene)})
        return
    from viewer.vertex_report import print_vertex

    print_vertex(record, scene, event, seen, ends)


def _reasons(record, scene):
    """What --why adds to the document."""
    from viewer.understanding.waterfall import waterfall
    from viewer.understanding.why import why
    from viewer.words import Speaker

    say = Speaker()
    reasons = [reason.as_dict(say) for reason in why(record, scene)]
    bars = [bar.as_dict() for bar in waterfall(record)]
    for row in (*reasons, *bars):  # a path is known by its sample here
        if row["path"] is not None:
            row["path"] = record.paths[row["path"]].sample
    return {"why": reasons, "made_of": bars}
