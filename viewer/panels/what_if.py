"""What if: the event the reader stands at, made to go otherwise; the path as it would be, and its ledger."""

import math

import numpy as np

import tracer
from tracer.recorder import number
from tracer.settings import TracerError
from tracer.what_if import FATES, KINDS, parse
from viewer.caption import caption
from viewer.numerals import NOTHING, css, several, short
from viewer.panels.panel import Panel
from viewer.panels.timeline import GLYPHS
from viewer.tuning import real_from

LARGEST_NUMBER = 0.999999  # that a page may ask of a random number

TEMPLATE = """
<div class="what-if" data-testid="what-if">
  <p class="dim">{{ what_if.note }}</p>
  <castray-knob v-for="knob in what_if.knobs" :key="what_if.at + knob.key" :knob="knob" call="suppose"></castray-knob>
  <template v-if="what_if.supposed.length">
    <h2>{{ w.what_if_supposed }}</h2>
    <div v-for="one in what_if.supposed" :key="one.key" class="row"><span class="grow">{{ one.text }}</span>
      <button :data-testid="'unsuppose-' + one.key" :aria-label="w.what_if_drop" :title="w.what_if_drop" @click="trigger('suppose_not', [one.key])">✕</button></div>
    <p><button data-testid="what-if-reset" @click="trigger('suppose_not')">{{ w.what_if_reset }}</button></p>
    <h2>{{ w.what_if_ledger }}</h2>
    <table class="data sums both"><tbody v-for="row in what_if.ledger" :key="row.name" :class="{total: row.total}">
      <tr><th scope="row" rowspan="2">{{ row.name }}</th><td class="dim">{{ w.what_if_is }}</td><td class="number">{{ row.now }}</td></tr>
      <tr><td class="dim">{{ w.what_if_would }}</td><td class="number" :data-testid="'what-if-' + row.key" :data-exact="JSON.stringify(row.exact)">{{ row.would }}</td></tr>
    </tbody></table>
    <h2>{{ w.what_if_path }}</h2>
    <ol class="would" data-testid="what-if-events"><li v-for="row in what_if.events" :key="row.step">
      <span class="kind" :class="row.kind"><i aria-hidden="true">{{ row.glyph }}</i> {{ row.name }}</span> <span class="dim">{{ row.text }}</span>
      <span v-if="row.adds" class="number"><i class="swatch" :style="{background: row.colour}"></i>{{ row.adds }}</span></li></ol>
    <h2>{{ w.change_command }}</h2><castray-command data-testid="what-if-command" :text="what_if.command"></castray-command>
  </template>
</div>
"""


def show(session, say):
    """The knobs of the event, and what is supposed with what follows from it."""
    event, there = session.event, session.supposition
    kind = event.kind.name
    found = {
        "at": f"{session.cursor.x},{session.cursor.y},{session.cursor.path}:",
        "note": say(f"what_if.at.{_question(session)}", name=session.given and session.given.name),
        "knobs": _KNOBS[kind](session, say) if _choice(session) else [],
        "supposed": [],
    }
    if there is None:
        return found
    supposed = [
        {"key": f"{depth}.{name}", "text": _said(depth, name, value, say)}
        for (depth, name), value in sorted(there.what.items())
    ]
    return found | {"supposed": supposed} | _outcome(session, there, say)


def _said(depth, name, value, say):
    """A supposition in words."""
    if name == "roulette":
        return say("what_if.said.roulette", depth=depth, fate=say(f"what_if.{value}"))
    told = dict(
        zip(("off", "turn") if name == "bounce" else ("which", "u1", "u2"), map(short, value), strict=True)
    )
    return say(f"what_if.said.{name}", depth=depth, **told)


def _choice(session):
    """Whether the event could have gone otherwise; a log may lack the surface that it is at."""
    event, before = session.event, session.path.events[: session.cursor.event]
    there = any(e.kind.name == "hit" for e in before)
    return (
        there and session.given is None and event.kind.name in KINDS and not event.values.get("delta", False)
    )


def _question(session):
    """What is asked of the event: by its kind, or why nothing can be."""
    if session.given is not None:
        return "given"
    if _choice(session):
        return session.event.kind.name
    return "dirac" if session.event.values.get("delta", False) else "none"


def _knob(event, part, label, value, low, high, step):
    return {
        "key": f"{event.depth}.{event.kind.name}.{part}",
        "label": label,
        "title": label,
        "kind": "range",
        "value": value,
        "low": low,
        "high": high,
        "step": step,
        "colour": "",
    }


def now(session):
    """What the event does as things stand: angles in degrees, random numbers, or a fate."""
    event = session.event
    key = event.depth, event.kind.name
    if key in session.suppositions:
        return session.suppositions[key]
    if event.kind.name == "roulette":
        return FATES[0] if event.values["survived"] else FATES[1]
    if event.kind.name == "light":
        return tuple(float(u) for u in event.values["u"])
    return _angles(session)


def _angles(session):
    """Degrees off the normal and about it of the direction that a bounce took."""
    events, step = session.path.events, session.cursor.event
    hit = next(e.values for e in reversed(events[:step]) if e.kind.name == "hit")
    scene = session.scene.at(session.settings)
    n, p, wi = (
        np.reshape(v, (3, 1)).astype(scene.dtype) for v in (hit["n"], hit["p"], session.event.values["wi"])
    )
    x, y, z = scene.frame(n, p, np.array([hit["primitive"]])).to_local(wi)[:, 0]
    return round(math.degrees(math.acos(np.clip(z, -1.0, 1.0))), 3), round(math.degrees(math.atan2(y, x)), 3)


def _bounce_knobs(session, say):
    off, turn = now(session)
    through = session.scene.is_see_through(int(_hit_shape(session)))
    return [
        _knob(session.event, 0, say("what_if.off"), off, 0, 180 if through else 90, 0.5),
        _knob(session.event, 1, say("what_if.turn"), turn, -180, 180, 1),
    ]


def _hit_shape(session):
    events = session.path.events[: session.cursor.event]
    return next(e.values["shape"] for e in reversed(events) if e.kind.name == "hit")


def _light_knobs(session, say):
    which, *place = now(session)
    knobs = [
        _knob(session.event, k + 1, say("what_if.place", sign="₁₂"[k]), u, 0, LARGEST_NUMBER, 0.01)
        for k, u in enumerate(place)
    ]
    if len(session.scene.light_names) > 1:
        knobs.insert(0, _knob(session.event, 0, say("what_if.which"), which, 0, LARGEST_NUMBER, 0.01))
    return knobs


def _roulette_knobs(session, say):
    choices = [{"value": fate, "text": say(f"what_if.{fate}")} for fate in FATES]
    label = say("what_if.fate")
    key = f"{session.event.depth}.roulette"
    return [
        {
            "key": key,
            "label": label,
            "title": label,
            "kind": "choice",
            "value": now(session),
            "choices": choices,
        }
    ]


_KNOBS = {"bounce": _bounce_knobs, "light": _light_knobs, "roulette": _roulette_knobs}


def _outcome(session, there, say):
    """The path as it would be: events, both ledgers, the pixel."""
    return {
        "ledger": [*_ledger(there, say), *_totals(session, there, say)],
        "events": [_row(event, session.scene, say) for event in there.path.events],
        "command": session.command,
    }


def _ledger(there, say):
    """What each event adds, by kind and depth: as it is, and as it would be."""
    sums = {}
    for side, path in enumerate((there.of, there.path)):
        for event in path.events:
            if np.any(event.values.get("contribution", 0) != 0):
                sums.setdefault((event.depth, event.kind.name), [NOTHING, NOTHING])[side] = several(
                    event.values["contribution"]
                )
    return [
        {
            "key": f"{kind}-{depth}",
            "name": say(f"ledger.{kind}", depth=depth),
            "now": both[0],
            "would": both[1],
        }
        for (depth, kind), both in sorted(sums.items())
    ]


def _totals(session, there, say):
    """The path's radiance and the pixel, as they are and as they would be."""
    paths = session.record.paths
    would = [there.path if path is there.of else path for path in paths]
    pixel = [tracer.fold(np.stack([p.radiance for p in some], axis=1)) for some in (paths, would)]
    sums = {
        "radiance": (say("ui.ledger_sum"), there.of.radiance, there.path.radiance),
        "pixel": (say("ledger.mean", n=len(paths)), *pixel),
    }
    return [
        {
            "key": key,
            "name": name,
            "now": several(now),
            "would": several(then),
            "exact": [number(v) for v in then],
            "total": True,
        }
        for key, (name, now, then) in sums.items()
    ]


def _row(event, scene, say):
    adds = event.values.get("contribution", np.zeros(3))
    kind = event.kind.name
    return {
        "step": event.step,
        "kind": kind,
        "glyph": GLYPHS[kind],
        "name": say(f"kind.{kind}"),
        "text": caption(event, scene, say),
        "adds": several(adds) if np.any(adds) else "",
        "colour": css(adds),
    }


def calls(window):
    """What the panel may ask for."""
    session = window.session

    def suppose(key, value):
        window.pause()
        session.suppose(session.suppositions | _asked(session, key, value))
        window.refresh("path")

    def suppose_not(key=None):
        window.pause()
        session.suppose(
            {}
            if key is None
            else {k: v for k, v in session.suppositions.items() if ".".join(map(str, k)) != key}
        )
        window.refresh("path")

    return {"suppose": suppose, "suppose_not": suppose_not}


def _asked(session, key, value):
    """The supposition that one knob of the current event stands for. Raises TracerError."""
    event = session.event
    name = f"{event.depth}.{event.kind.name}"
    if not isinstance(key, str) or key.rpartition(".")[0] != name and key != name or not _choice(session):
        raise TracerError(f"what_if: {str(key)[:40]!r} is not what can be changed at this event")
    if event.kind.name == "roulette":
        return parse([f"{name}={str(value)[:20]}"])
    part, values = key.rpartition(".")[2], list(now(session))
    if not (part.isascii() and part.isdecimal() and int(part) < len(values)):
        raise TracerError(f"what_if: {key[:40]!r} is not what can be changed at this event")
    low, high = (-360.0, 360.0) if event.kind.name == "bounce" else (0.0, LARGEST_NUMBER)
    values[int(part)] = real_from(name, value, low, high)
    return parse([f"{name}={','.join(map(repr, values))}"])


PANEL = Panel("what_if", "tab", "event", 50, TEMPLATE, show, calls)
