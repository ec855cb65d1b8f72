"""Files of the moment that the viewer stands at, as bytes."""

import re
import tempfile
from dataclasses import dataclass, replace
from json import dumps
from pathlib import Path
from typing import Any

import numpy as np

import tracer
from lessons.zoo import planted
from tracer.settings import TracerError
from tracer.what_if import supposed
from viewer.examining import examined
from viewer.hemisphere import Hemisphere
from viewer.offline import page
from viewer.replay import replayed
from viewer.sharing.report import report
from viewer.surfaces import sight
from viewer.understanding.lens import SHOWN
from viewer.understanding.lens import here as lens_here


@dataclass(frozen=True)
class Moment:
    """What files are made of, as it was when one was asked for: a session goes on meanwhile."""

    scene: Any
    settings: tracer.Settings
    recording: Any
    given: Any  # paths of another tracer, in place of castray's own
    picture: Any  # None until some of it is rendered
    record: Any
    cursor: Any
    suppositions: dict  # {(depth, kind): value} of the path
    chart: Any  # of the doctor, if it was asked
    lens: Any  # over the vertex, if it is shown in 3D
    say: Any

    @classmethod
    def of(cls, session, say):
        """The moment of a session."""
        c, s = session.cursor, session
        return cls(
            s.scene,
            s.settings,
            s.recording,
            s.given,
            s.picture,
            s.record,
            c,
            s.suppositions,
            s.desk.get("doctor"),
            lens_here(s) if s.shelf.get(SHOWN) else None,
            say,
        )

    def file(self, name):
        """(name to keep it under, bytes) of one of FILES. Raises TracerError."""
        ending = Path(name).suffix
        parts = {"path": f"-{self.cursor.x}-{self.cursor.y}-{self.cursor.path}",
                 "view": f"-{self.cursor.x}-{self.cursor.y}", "doctor": "-doctor"}  # fmt: skip
        stem = re.sub(r"[^A-Za-z0-9._-]", "_", self.scene.name) + parts.get(Path(name).stem, "")
        return f"{stem}{ending}", FILES[name](self)


def _picture(ending):
    def made(moment):
        if moment.picture is None:
            raise TracerError("share: there is no picture yet")
        with tempfile.TemporaryDirectory(prefix="castray-") as folder:
            file = Path(folder) / f"picture{ending}"
            tracer.write(moment.picture, file, scene=moment.scene.name)
            return file.read_bytes()

    return made


def _path(moment):
    """The JSON of `castray inspect --sample`, of the path as it is supposed to be where it is."""
    m, c = moment, moment.cursor
    sample, steps = m.record.paths[c.path].sample, planted(m.settings)
    if m.given is not None:
        record = replace(m.record, paths=(m.record.paths[c.path],))
    elif m.suppositions:
        record = supposed(m.scene, m.settings, c.x, c.y, sample, m.suppositions, steps)
    else:
        record = tracer.inspect(m.scene, m.settings, c.x, c.y, sample, steps)
    return (dumps(record.as_dict(m.scene.at(m.settings)), allow_nan=False) + "\n").encode("ascii")


def _view(moment):
    m, rgb = moment, None if moment.picture is None else moment.picture.rgb
    size = float(np.linalg.norm(np.subtract(*sight(m.scene))))
    over = Hemisphere(m.lens, size, m.say) if m.lens else None
    return page(m.scene, m.record, m.cursor, m.say, rgb, over).encode("utf-8")


def _doctor(moment):
    m, chart = moment, moment.chart
    if chart is None or chart.diagnosis is None:
        chart = examined(m.scene, m.settings, m.recording, lambda: None)
    if m.given is not None:
        return report(chart.diagnosis, m.scene, m.settings, chart.paths, m.say, again=False).encode("utf-8")
    folder = m.recording and m.recording.path
    diagnosis = replayed(chart.diagnosis, m.scene, m.settings, folder)
    return report(diagnosis, m.scene, m.settings, chart.paths, m.say).encode("utf-8")


FILES = {
    "picture.png": _picture(".png"),
    "picture.exr": _picture(".exr"),
    "path.json": _path,
    "view.html": _view,
    "doctor.html": _doctor,
}
