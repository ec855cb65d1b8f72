"""Tests of pictures and traces, for anybody's regression suite.

In a test of yours:

    from tracer.testing import assert_healthy, assert_same_picture
    assert_same_picture(tracer.render(scene, settings), tracer.read("reference.exr"))
    assert_healthy("mine.jsonl", scene="cornell")
"""

from tracer.testing.calibration import Calibration, calibration
from tracer.testing.compare import assert_same_picture, compare
from tracer.testing.errors import Errors, errors
from tracer.testing.health import assert_healthy
from tracer.testing.ztest import Comparison, z_test

__all__ = [
    "Calibration",
    "Comparison",
    "Errors",
    "assert_healthy",
    "assert_same_picture",
    "calibration",
    "compare",
    "errors",
    "z_test",
]
