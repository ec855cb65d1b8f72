"""Findings of distributions, tried on fresh and larger data where the tracer can be asked again.

A right trace breaks a statistical law once in 10 000 times. Whoever looks at many traces meets one; that it
breaks the same law with other numbers as well is as rare again.
"""

from dataclasses import replace

import numpy as np

from tracer.doctor import statistics
from tracer.doctor.causes import followed, ranked
from tracer.doctor.evidence import Evidence
from tracer.doctor.rule import CLEAN, FIRED

TIMES = 2  # as many samples
_OTHER = 0xF8E5  # exclusive-or of the seed: other numbers than the trace's and its reference's


def fresh(settings):
    """The Settings of fresh and larger data."""
    return replace(settings.at_spp(TIMES * settings.spp), seed=settings.seed ^ _OTHER)


def by_chance(diagnosis):
    """Whether it has a cause that only a distribution shows, and that was not tried on fresh data."""
    return any(f.p is not None and not f.confirmed for f in diagnosis.causes)


def confirmed(diagnosis, trace):
    """The Diagnosis without the findings of distributions that a Trace of fresh data does not show; the
    others are marked."""
    asked = {f.rule for f in diagnosis.findings if f.p is not None}
    again = {v.rule.id for v in statistics.judged(Evidence(trace), asked) if v.state == FIRED}
    kept = [f for f in diagnosis.findings if f.p is None or f.rule in again]
    kept = [f if f.p is None else replace(f, confirmed=True) for f in kept]
    if len(kept) < len(diagnosis.findings):
        kept = ranked([replace(f, follows=None) for f in kept], followed(kept))
    rules = (_cleared(v) if v.rule.id in asked - again else v for v in diagnosis.rules)
    return replace(diagnosis, findings=tuple(kept), rules=tuple(rules))


def _cleared(verdict):
    """A verdict that was chance."""
    outcome = verdict.outcome
    if outcome is not None:
        outcome = replace(outcome, wrong=np.zeros_like(outcome.wrong))
    return replace(verdict, state=CLEAN, failed=0, outcome=outcome)
