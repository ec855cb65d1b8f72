"""The selected path as a line of events, with the buttons that walk it."""

import numpy as np

from viewer.comparing.comparer import beside
from viewer.panels.panel import Panel

TEMPLATE = """
<section class="timeline" :aria-label="w.timeline">
  <div class="buttons" role="toolbar" :aria-label="w.walk">
    <button v-for="b in ['first', 'previous', 'play', 'next', 'last']" :key="b" :data-testid="b"
      :aria-label="b === 'play' && playing ? w.pause : w[b]" :title="b === 'play' && playing ? w.pause : w[b]"
      @click="trigger(b === 'play' ? 'play' : 'go', [b])"><castray-icon :name="b === 'play' && playing ? 'pause' : b"/></button>
  </div>
  <ol class="track" :class="{tight: timeline.marks.length > 20}" data-testid="timeline">
    <li v-for="mark in timeline.marks" :key="mark.step" :class="{vertex: mark.vertex}">
      <button class="mark" :class="[mark.kind, {now: mark.step === event_index, gives: mark.gives, past: mark.step < event_index, parts: mark.step === timeline.parts}]"
        :data-testid="'mark-' + mark.step" :title="mark.title" :aria-label="mark.title"
        :aria-current="mark.step === event_index ? 'step' : null" @click="trigger('event', [mark.step])">{{ mark.glyph }}</button></li>
  </ol>
  <div class="buttons paths" role="group" :aria-label="w.paths">
    <button data-testid="up" :aria-label="w.up" :title="w.up" @click="trigger('go', ['up'])"><castray-icon name="up"/></button>
    <span class="of" data-testid="path-of">{{ timeline.path }}</span>
    <button data-testid="down" :aria-label="w.down" :title="w.down" @click="trigger('go', ['down'])"><castray-icon name="down"/></button>
  </div>
</section>
<section v-if="timeline.twin" class="timeline beside" :aria-label="w.timeline_twin" data-testid="twin-timeline"><span class="of">{{ timeline.twin.name }}</span>
  <ol class="track" :class="{tight: timeline.twin.marks.length > 20}">
    <li v-for="mark in timeline.twin.marks" :key="mark.step" :class="{vertex: mark.vertex}"><span class="mark" role="img" :class="[mark.kind, {gives: mark.gives, parts: mark.step === timeline.twin.parts}]"
      :data-testid="'twin-mark-' + mark.step" :title="mark.title" :aria-label="mark.title">{{ mark.glyph }}</span></li></ol></section>
"""
GLYPHS = {"camera": "◉", "hit": "●", "light": "✦", "bounce": "↗", "roulette": "⚄", "escape": "↠", "end": "■"}


def show(session, say):
    """One mark an event; those that add light are marked, and where the path leaves its twin."""
    path = say("timeline.path", path=session.cursor.path, n=len(session.record.paths))
    shown = {"marks": _marks(session.path, say), "path": path, "parts": None, "twin": None}
    there = beside(session)
    if there is None:
        return shown
    mine, its = there.parting.steps if there.parting else (None, None)
    twin = {"name": say("timeline.twin"), "marks": _marks(there.path, say), "parts": its}
    return shown | {"parts": mine, "twin": twin}


def _marks(path, say):
    return [
        {
            "step": step,
            "kind": event.kind.name,
            "glyph": GLYPHS[event.kind.name],
            "vertex": event.kind.name in ("hit", "end"),
            "gives": bool(np.any(event.values.get("contribution", 0) > 0)),
            "title": say("timeline.mark", event=step, kind=say(f"kind.{event.kind.name}"), depth=event.depth),
        }
        for step, event in enumerate(path.events)
    ]


PANEL = Panel("timeline", "below", "path", 10, TEMPLATE, show)
