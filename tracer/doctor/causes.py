"""Which of several broken laws is the cause, and which are broken because of it."""

from dataclasses import replace

import numpy as np

from tracer.doctor import statistics
from tracer.doctor.statistics.cells import FEW

# What breaks together: where the first of a group is broken, the others are too, by the same mistake.
_TOGETHER = (
    ("camera-ray", "camera-start", "chain", "escape-direction", "own-surface", "first-surface", "escape-free",
    "on-surface", "distance", "wo"),
    ("unit-normal", "normal", "shading-normal", "side"),
    ("bounce-mirror", "bounce-mirror-f", "bounce-mirror-pdf"),
    ("bounce-side", "bounce-f", "bounce-pdf"),
    ("transmittance", "light-transmittance", "throughput-on-arrival"),
    ("emission", "pdf-of-light"),
    ("roulette-probability", "roulette-played"),
    ("light-pick", "light-pdf"),
    ("light-radiance", "light-pdf"),
    ("unit-light", "light-visible"),
    ("light-normal", "light-radiance"),
)  # fmt: skip
# Where a path goes on, and what it can only meet wrongly after it went on wrongly.
_WAY = ("unit-direction", "bounce-side", "bounce-mirror", "chain")
_MET = ("on-surface", "unit-normal", "normal", "shading-normal", "chain", "own-surface", "first-surface",
    "distance", "wo", "side", "emission", "pdf-of-light", "light-due", "bounce-side", "bounce-mirror",
    "bounce-mirror-f", "bounce-mirror-pdf")  # fmt: skip
# What is held against the scene where the log has no number of its own: another surface, another number.
_OF_SCENE = {"throughput": "bounce.f", "roulette-weight": "bounce.f", "light-term": "light.f"}
_UNCARRIED = ("bounce-side", "bounce-f", "bounce-pdf", "light-due")  # why a bounce may carry nothing
_OF_MANY = tuple(rule.id for rule in statistics.RULES)
_NUMBERS = ("numbers-once", "numbers-uniform", "numbers-independent")
_BOUNCES = ("unit-normal", "normal", "shading-normal", "unit-direction", "wo", "absorbed", "bounce-")
_AMOUNTS = ("bounce-f", "bounce-cos")  # which say nothing of where bounces go
_ALWAYS_LATER = ("light-nothing", "domain", "finite")  # what any mistake may lead to
_AFTER = 0.999  # share of a law's events that have to come after those of another
_ENOUGH = 0.25  # times as often as a law what is to be the cause of it has to be broken


def led_astray(trace, judged):
    """Id of a law -> id of the law of the way that was broken before it on each path where it is broken.

    judged: of each law its rule, its finding if it is broken, and where(trace) it is.
    """
    found, broken = {}, [each for each in judged if each.finding is not None]
    for lead in broken:
        if lead.rule.id not in _WAY:
            continue
        path, step = lead.where(trace)
        first = np.full(trace.size, np.inf)
        np.minimum.at(first, path, step)
        for each in broken:
            met = each.rule.id in _MET or _OF_SCENE.get(each.rule.id) in trace.assumed
            if met and each.rule.id != lead.rule.id:
                path, step = each.where(trace)
                if (step >= first[path]).mean() >= _AFTER:
                    found.setdefault(each.rule.id, lead.rule.id)
    return {rule: lead for rule, lead in found.items() if lead not in found}


def ranked(findings, led=None):
    """Causes first, in the order of the rules, those last of which there are but few events; then what
    follows from them. led: id of a law -> id of the one that is broken before it."""
    led = led or {}
    counts = {f.rule: f.count for f in findings}
    often = [f.rule for f in findings if f.rule in _OF_MANY or f.count > FEW * np.sqrt(f.checked)]
    rare = {f.rule for f in findings} - set(often)
    ordered = []
    for f in findings:
        cause = led.get(f.rule) or _cause(f.rule, counts, often)
        if f.rule == "absorbed" and f.bug is None:
            cause = next((other for other in counts if other in _UNCARRIED), None)
        ordered.append(f if cause is None else _following(f, cause))
    return tuple(sorted(ordered, key=lambda f: (f.follows is not None, f.follows is None and f.rule in rare)))


def followed(findings):
    """Id of a law -> id of the cause that it was found to follow from on its paths, of those still there."""
    there = {f.rule for f in findings}
    return {
        f.rule: f.follows
        for f in findings
        if (f.rule in _MET or f.rule in _OF_SCENE) and f.follows in _WAY and f.follows in there
    }


def _cause(rule, counts, often):
    if rule in _OF_MANY:
        return next((other for other in often if _explains(other, rule)), None)
    if rule in _ALWAYS_LATER:
        causes = (other for other in counts if other not in _ALWAYS_LATER)
        return next((other for other in causes if counts[other] >= _ENOUGH * counts[rule]), None)
    for group in _TOGETHER:
        if rule in group:
            for other in group[: group.index(rule)]:
                if counts.get(other, 0) >= _ENOUGH * counts[rule]:
                    return other
    return None


def _explains(cause, rule):
    """Whether a broken law may be why a statistical one is."""
    if cause == rule or (cause in _OF_MANY and _OF_MANY.index(cause) > _OF_MANY.index(rule)):
        return False
    if rule in _NUMBERS:
        return cause in _NUMBERS or cause == "absorbed"
    if rule == "film":
        return cause in _NUMBERS or cause.startswith("camera")
    if rule in ("mean", "variance") or cause in _NUMBERS:
        return True
    if rule.startswith("directions"):
        going = cause.startswith(_BOUNCES) and cause not in _AMOUNTS
        return going or cause.startswith("directions")
    if rule.startswith("lamp"):
        return cause.startswith("light-") or cause.startswith("lamp")
    return cause.startswith("roulette")


def _following(finding, cause):
    return replace(finding, follows=cause, bug=None, alike=())
