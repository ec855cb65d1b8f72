"""What a lesson's run traces is what the commands show."""

import numpy as np
import pytest

from lessons.course import lesson
from lessons.run import Run
from tracer import fold


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
