"""A learner's cast_ray in Python, run and judged."""

from dataclasses import replace

import tracer
from tracer.doctor.causes import followed, ranked
from tracer.doctor.diagnosis import Diagnosis
from tracer.doctor.rule import NOT_TESTABLE
from tracer.learner.run import run
from viewer.options import CheckOptions, Unsaid, settings_and_steps
from viewer.replay import view_of

SIDE, SPP = 24, int(CheckOptions().spp)  # of the small picture that is traced unless said


def settings_of(options):
    """float64, pixel centres and lamps sampled by area, as the homework has them."""
    settings, _ = settings_and_steps(options)
    if settings.width is None:
        settings = replace(settings, width=SIDE, height=SIDE)
    if options is None or isinstance(options.spp, Unsaid):
        settings = replace(settings, spp=SPP)
    return replace(settings, precision=64, integrator="direct", light_sampling="area", jitter=False)


def said(settings):
    """Settings as options of castray check and castray view, with a space before each; those that they would
    have anyway are left out."""
    plain, words = settings_of(None), []
    if (settings.width, settings.height) != (plain.width, plain.height):
        words.append(f" --size {settings.width} {settings.height}")
    for name in ("spp", "seed", "hemisphere", "accel"):
        if getattr(settings, name) != getattr(plain, name):
            words.append(f" --{name} {getattr(settings, name)}")
    return "".join(words)


def examined(file, scene, options, seconds, quiet=False):
    """The Diagnosis of a learner's file, each finding with the command that opens it at its event, and its
    Trace. quiet: what it prints goes nowhere. Raises TracerError."""
    settings = settings_of(options)
    whole, bright = run(file, scene, settings, seconds, quiet)
    diagnosis = judged(whole, bright)
    return diagnosis.shown_by(lambda first: view_of(file, scene, whole, first) + said(settings)), whole


def judged(whole, bright):
    """One diagnosis of a learner's two traces."""
    return together(*held(whole, bright))


def held(whole, bright):
    """The diagnoses of a learner's two traces: what that of all light samples cannot test is asked of that of
    the bright ones, so that no law is held twice."""
    first = tracer.examine(whole)
    return first, tracer.examine(bright, {v.rule.id for v in first.rules if v.state == NOT_TESTABLE})


def together(first, later):
    """One diagnosis of two. The commands that would replay castray's own paths are left out."""
    rules = {v.rule.id: v for v in (*first.rules, *later.rules)}
    order = list(rules)
    found = sorted((*first.findings, *later.findings), key=lambda f: order.index(f.rule))
    alone = [replace(f, command=None) for f in found]
    return Diagnosis(ranked(alone, followed(found)), tuple(rules.values()))
