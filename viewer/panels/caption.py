"""The current event in words, and why a dead path carries nothing."""

from viewer.caption import caption, why_dead
from viewer.panels.panel import Panel

TEMPLATE = """
<section class="panel caption" aria-live="polite" :aria-label="w.caption">
  <div class="where"><span class="kind" :class="caption.kind" data-testid="event-kind">{{ caption.name }}</span>
    <span class="dim" data-testid="event-place">{{ caption.place }}</span></div>
  <p data-testid="caption">{{ caption.text }}</p>
  <p v-if="caption.dead" class="dead" data-testid="why-dead"><b aria-hidden="true">∅</b> {{ caption.dead }}</p>
</section>
"""


def show(session, say):
    """The sentence of the event and where it stands."""
    event, cursor = session.event, session.cursor
    return {
        "kind": event.kind.name,
        "name": say(f"kind.{event.kind.name}"),
        "place": say(
            "caption.place",
            event=cursor.event,
            events=cursor.lengths[cursor.path] - 1,
            depth=event.depth,
            path=session.path.sample,
        ),
        "text": caption(event, session.scene, say),
        "dead": why_dead(session.path, session.scene, say),
    }


PANEL = Panel("caption", "right", "event", 10, TEMPLATE, show)
