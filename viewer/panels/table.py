"""The table of events of the selected path; a click on a row goes there."""

import numpy as np

from viewer.caption import caption
from viewer.numerals import css, several
from viewer.panels.panel import Panel
from viewer.panels.timeline import GLYPHS
from viewer.session import throughput

TEMPLATE = """
<section class="events" :aria-label="w.table" tabindex="-1">
  <table data-testid="event-table" :data-pixel="table.pixel" :data-path="table.path">
    <thead><tr><th scope="col">#</th><th scope="col">{{ w.col_event }}</th><th scope="col">{{ w.col_depth }}</th>
      <th scope="col">{{ w.col_what }}</th><th scope="col">{{ w.col_beta }}</th><th scope="col">{{ w.col_adds }}</th></tr></thead>
    <tbody><tr v-for="row in table.rows" :key="row.step" :class="{now: row.step === event_index}"
      :data-testid="'row-' + row.step" :aria-current="row.step === event_index ? 'true' : null" :data-now="row.step === event_index"
      @click="trigger('event', [row.step])">
      <td class="number">{{ row.step }}</td>
      <td><span class="kind" :class="row.kind"><i aria-hidden="true">{{ row.glyph }}</i> {{ row.name }}</span></td>
      <td class="number">{{ row.depth }}</td><td class="what" :title="row.text">{{ row.text }}</td>
      <td class="number">{{ row.beta }}</td>
      <td class="number"><i v-if="row.colour" class="swatch" :style="{background: row.colour}"></i>{{ row.adds }}</td>
    </tr></tbody>
  </table>
</section>
"""


def show(session, say):
    """One row an event."""
    cursor = session.cursor
    rows = [_row(session, step, event, say) for step, event in enumerate(session.path.events)]
    return {"rows": rows, "pixel": f"{cursor.x},{cursor.y}", "path": cursor.path}


def _row(session, step, event, say):
    adds = event.values.get("contribution")
    return {
        "step": step,
        "kind": event.kind.name,
        "glyph": GLYPHS[event.kind.name],
        "name": say(f"kind.{event.kind.name}"),
        "depth": event.depth,
        "text": caption(event, session.scene, say),
        "beta": several(throughput(session.path.events, step)),
        "adds": "" if adds is None else several(adds),
        "colour": css(adds) if adds is not None and np.any(adds > 0) else "",
    }


PANEL = Panel("table", "below", "path", 20, TEMPLATE, show)
