"""A learner's cast_ray in Python, run and judged."""

from dataclasses import replace

import tracer
from tracer.learner.run import run
from viewer.options import CheckOptions, settings_and_steps

SIDE, SPP = 24, 8  # of the small picture that is traced unless said


def settings_of(options):
    """float64, pixel centres and lamps sampled by area, as the homework has them."""
    settings, _ = settings_and_steps(options)
    if settings.width is None:
        settings = replace(settings, width=SIDE, height=SIDE)
    if options is None or options.spp == CheckOptions().spp:
        settings = replace(settings, spp=SPP)
    return replace(settings, precision=64, integrator="direct", light_sampling="area", jitter=False)


def examined(file, scene, options, seconds, quiet=False):
    """The Diagnosis of a learner's file, and its Trace. quiet: what it prints goes nowhere. Raises
    TracerError."""
    traces = run(file, scene, settings_of(options), seconds, quiet)
    return together(*(tracer.examine(trace) for trace in traces)), traces[0]


def together(first, second):
    """One diagnosis of two: what the first could not test is what the second says. The commands that would
    replay castray's own paths are left out."""
    open_ = {verdict.rule.id for verdict in first.rules if verdict.state == "not_testable"}
    later = {verdict.rule.id: verdict for verdict in second.rules}
    rules = tuple(later[v.rule.id] if v.rule.id in open_ else v for v in first.rules)
    more = [f for f in second.findings if f.rule in open_]
    seen = [f for f in first.findings if f.p is None]
    means = [f for f in first.findings if f.p is not None]
    if more:  # what is off on average is so because of them
        cause = next((f.rule for f in (*seen, *more) if f.follows is None), None)
        means = [replace(f, follows=cause, bug=None, alike=()) for f in means]
    findings = tuple(replace(f, command=None) for f in (*seen, *more, *means))
    return replace(first, findings=findings, rules=rules)
