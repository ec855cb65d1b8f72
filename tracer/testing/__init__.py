"""Statistical tests of pictures, for anybody's regression suite.

from tracer.testing import assert_same_picture
assert_same_picture(tracer.render(scene, settings), tracer.read("reference.exr"))
"""

from tracer.testing.calibration import Calibration, calibration
from tracer.testing.compare import assert_same_picture, compare
from tracer.testing.errors import Errors, errors
from tracer.testing.ztest import Comparison, z_test

__all__ = [
    "Calibration",
    "Comparison",
    "Errors",
    "assert_same_picture",
    "calibration",
    "compare",
    "errors",
    "z_test",
]
