"""Two traces of the same random numbers in step: where they part, and what that does to the picture.

A path's numbers are a pure function of seed, pixel, sample, depth and use. Two tracers that are given the
same ones follow the same path as long as they do the same, so the first event that differs is where one of
them does something else; whatever comes after it is a consequence.
"""

from tracer.twin.comparison import Cause, Parting, Share, Twin, compare

__all__ = ["Cause", "Parting", "Share", "Twin", "compare"]
