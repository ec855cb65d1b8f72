"""Learners' own tracers in Python, asked ray by ray: what they did becomes a Trace like any other."""

from tracer.learner.value import Vector, cross, dot, length, normalize
from tracer.learner.world import Ray

__all__ = ["Ray", "Vector", "cross", "dot", "length", "normalize"]
