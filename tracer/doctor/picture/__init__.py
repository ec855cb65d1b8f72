"""What a picture alone says of its tracer: hypotheses, never findings."""

from tracer.doctor.picture.clues import Clues, clues
from tracer.doctor.picture.features import Features, features, resampled
from tracer.doctor.picture.fitting import Fit, Looks, fit, misfit
from tracer.doctor.picture.hypotheses import FITS, LEAST, Hypothesis, Opinion, judged, likelier_curve
from tracer.doctor.picture.reading import opened
from tracer.doctor.picture.walls import Wall, predicted, strangest

__all__ = [
    "FITS",
    "LEAST",
    "Clues",
    "Features",
    "Fit",
    "Hypothesis",
    "Looks",
    "Opinion",
    "Wall",
    "clues",
    "features",
    "fit",
    "judged",
    "likelier_curve",
    "misfit",
    "opened",
    "predicted",
    "resampled",
    "strangest",
]
