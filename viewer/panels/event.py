"""Every number of the current event, with its meaning and unit."""

from tracer.recorder import plain
from viewer.caption import applies, shown, unit_of
from viewer.numerals import css
from viewer.panels.panel import Panel

TEMPLATE = """
<dl class="data" data-testid="event-data" :aria-label="w.event">
  <div v-for="row in event.rows" :key="row.name" :data-testid="'field-' + row.name">
    <dt><code>{{ row.name }}</code></dt>
    <dd :data-exact="JSON.stringify(row.exact)"><i v-if="row.colour" class="swatch"
      :style="{background: row.colour}"></i><span class="number">{{ row.value }}</span>
      <span class="unit">{{ row.unit }}</span></dd>
    <small>{{ row.meaning }}</small>
  </div>
</dl>
"""
COLOURED = ("Le", "f", "transmittance", "beta", "beta_before", "contribution", "radiance", "F")


def show(session, say):
    """One row for each field that means something here; labels and units are the schema's own."""
    kind, values = session.event.kind, session.event.values
    fields = [field for field in kind.fields if applies(field, values[field.name])]
    return {"rows": [_row(kind, field, values[field.name], session.scene, say) for field in fields]}


def _row(kind, field, value, scene, say):
    return {
        "name": field.name,
        "meaning": say.meaning(kind, field.name),
        "value": shown(field, value, scene, say),
        "unit": unit_of(field),
        "exact": plain(value, field, scene),
        "colour": css(value) if field.name in COLOURED else "",
    }


PANEL = Panel("event", "tab", "event", 10, TEMPLATE, show)
