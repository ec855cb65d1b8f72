"""What a lesson's run traces is what the commands show."""

import numpy as np
import pytest

import tracer
from lessons.course import lesson
from lessons.lesson import Lesson
from lessons.run import Run
from tracer import fold
from tracer.scene_file.change import changed
from tracer.settings import TracerError
from viewer.link import of_moment, parse


@pytest.mark.parametrize("moment", ["start", "mistake"])
def test_a_wave_of_samples_is_the_pixel_that_is_recorded(moment):
    run = Run(lesson(4))
    at = run.lesson.moments[moment]
    assert np.array_equal(fold(run.wave(moment).radiance), run.pixel(at.x, at.y, moment).value)


def test_a_wave_takes_settings_said_differently():
    run = Run(lesson(4))
    few, many = run.wave(), run.wave(spp=32, seed=0)
    assert many.radiance.shape == (3, 32) and many.rays > few.rays
    assert np.array_equal(many.radiance[:, : few.settings.spp], few.radiance)


def test_a_moment_that_says_its_scene_differently_is_traced_so_and_its_link_opens_there():
    run = Run(lesson(4))
    assert run.event("start")["lobe"] == "transmission" and run.event("diamond")["lobe"] == "reflection"
    at, link = run.lesson.moments["thinned"], of_moment(run.lesson.moments["thinned"])
    assert parse(link.write()) == link and link.changes == {"thickest.interior.sigma_t": [0.025, 0.12, 0.6]}
    scene = changed(tracer.load(link.scene), link.changes)
    record = tracer.inspect(scene, link.settings.at_size_of(scene), at.x, at.y)
    hit = record.paths[at.path].events[at.event].values
    assert hit["transmittance"].tolist() == pytest.approx(run.event("thinned")["transmittance"], rel=1e-6)
    assert np.allclose(
        hit["transmittance"], np.exp(-float(hit["t"]) * np.array([0.025, 0.12, 0.6])), rtol=1e-5
    )
    assert np.all(hit["transmittance"] > run.event("amber")["transmittance"])


def test_what_a_moment_may_not_say_differently_is_refused():
    it = Lesson(lesson(4).folder)
    it.front["moment"]["start"]["set"] = ["water.bsdf.filename=x"]
    with pytest.raises(TracerError, match="numbers and words only"):
        _ = it.moments
