"""An event in words, and why a dead path carries nothing."""

from collections import Counter

import numpy as np

from tracer.events import END, UNSAID
from viewer.numerals import several, short

TABLES = {
    "shape": lambda scene: [shape.name for shape in scene.shapes],
    "bsdf": lambda scene: scene.bsdf_names,
    "light": lambda scene: scene.light_names,
}


def name_of(field, value, scene):
    """The name that a whole number in the record stands for; None if there is none."""
    names = field.choices or TABLES[field.domain](scene)
    return names[int(value)] if 0 <= int(value) < len(names) else None


def shown(field, value, scene, say):
    """One field's value as a person reads it."""
    if field.domain in ("choice", *TABLES):
        name = name_of(field, value, scene)
        return say("value.none") if name is None else say.optional(f"choice.{name}", name)
    if field.domain == "flag":
        return say("value.yes") if value else say("value.no")
    if field.domain == "index":
        return str(int(value))
    return several(value)


def unit_of(field):
    """A field's unit as a person reads it: none for a length, since no scene says what its unit is."""
    return "" if field.unit == "m" else field.unit


def applies(field, value):
    """Whether a field means anything at its event.

    A derived one that does not is NaN throughout, and one that the loop may leave out has the schema's value.
    """
    value = np.asarray(value)
    if not np.issubdtype(value.dtype, np.floating):
        return True
    nothing = np.isnan(value) if field.otherwise is None else value == field.otherwise
    return not nothing.all()


def caption(event, scene, say):
    """One or two sentences that say what this event is and does."""
    return CAPTIONS[event.kind.name](event.values, scene, say)


def _camera(v, scene, say):
    if not np.all(np.isfinite(v["film"])):  # a log need not have it
        return say("caption.camera.only")
    return say("caption.camera", x=short(v["film"][0]), y=short(v["film"][1]))


def _hit(v, scene, say):
    text = say("caption.hit", shape=named("shape", v["shape"], scene), t=short(v["t"]))
    if not np.any(v["Le"] > 0):
        return say.sentences(text, _through(v, say))
    counted = "caption.hit.adds" if v["w"] > 0 else "caption.hit.counted_elsewhere"
    return say.sentences(text, _through(v, say), say(counted, w=short(v["w"])))


def light_outcome(v):
    """What became of a light sample: undefined, behind, below, absorbed, blocked, denied (it counts as
    hidden, though nothing is in the way), lit or nothing; unsaid by a log that has what it brings alone."""
    if v["light"] < 0 and not np.all(np.isfinite(v["q"])):
        return "unsaid"
    if no_number(v):
        return "undefined"
    if v["cos_light"] <= 0:
        return "behind"
    if not np.any(v["f"] > 0):
        return "below"
    if not np.any(v["transmittance"] > 0):  # nothing can arrive: whether q is seen was not asked
        return "absorbed"
    if not v["visible"]:
        return "blocked" if v["blocker"] >= 0 else "denied"
    return "lit" if np.any(v["contribution"] > 0) else "nothing"


def no_number(v):
    """Whether what a light sample brings is NaN, and what it is made of, too; a log may lack one of them."""
    return bool(np.isnan(v["contribution"]).any() and (np.isnan(v["f"]).any() or np.isnan(v["pdf"])))


def _light(v, scene, say):
    outcome = light_outcome(v)
    text = say(
        f"caption.light.{outcome}",
        light=named("light", v["light"], scene),
        blocker=named("shape", v["blocker"], scene),
        distance=short(v["distance"]),
        at=short(v["blocker_distance"]),
        w=short(v["w"]),
        added=several(v["contribution"]),
    )
    return say.sentences(text, _through(v, say)) if outcome == "lit" else text


def _through(v, say):
    """What coloured glass lets through on the way, if there is any."""
    left = v["transmittance"]
    return "" if np.all(left == 1.0) else say("caption.through", left=several(left))


def _bounce(v, scene, say):
    return say("caption.bounce.delta" if v["delta"] else "caption.bounce", pdf=short(v["pdf"]))


def _roulette(v, scene, say):
    key = "caption.roulette.survived" if v["survived"] else "caption.roulette.ended"
    if not np.isfinite(v["u"]):
        return say(f"{key}.only", q=short(v["probability"]))
    return say(key, q=short(v["probability"]), u=short(v["u"]))


def _escape(v, scene, say):
    return say("caption.escape.adds" if np.any(v["contribution"] > 0) else "caption.escape")


def _end(v, scene, say):
    reason = END.field("reason").choices[int(v["reason"])] if v["reason"] >= 0 else UNSAID
    return say.sentences(say(f"caption.end.{reason}"), say("caption.end", radiance=several(v["radiance"])))


CAPTIONS = {
    "camera": _camera,
    "hit": _hit,
    "light": _light,
    "bounce": _bounce,
    "roulette": _roulette,
    "escape": _escape,
    "end": _end,
}


def why_dead(path, scene, say):
    """One sentence on why a path carries nothing; empty for a path that carries something."""
    if np.any(np.asarray(path.radiance) > 0):
        return ""
    samples = [e.values for e in path.events if e.kind.name == "light"]
    reasons = Counter(_reason(v, scene, say) for v in samples)
    if not samples:
        lights = say("dead.no_samples")
    elif len(reasons) == 1:
        lights = say(
            "dead.one" if len(samples) == 1 else "dead.all", n=len(samples), reason=next(iter(reasons))
        )
    else:
        parts = say.clauses(*(say("dead.part", n=n, reason=reason) for reason, n in reasons.most_common()))
        lights = say("dead.some", n=len(samples), parts=parts)
    return say("dead", end=say(f"dead.{path.end}"), lights=lights)


def _reason(v, scene, say):
    return say(f"dead.light.{light_outcome(v)}", blocker=named("shape", v["blocker"], scene))


def named(domain, value, scene):
    """The name that a number stands for in one of the scene's TABLES."""
    names = TABLES[domain](scene)
    return names[int(value)] if 0 <= int(value) < len(names) else "?"
