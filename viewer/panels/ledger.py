"""The ledger: the pixel is the mean of its samples, a sample the sum of its contributions, and it adds up."""

import numpy as np

import tracer
from tracer.recorder import number
from viewer.numerals import css, several
from viewer.panels.panel import Panel

TEMPLATE = """
<div class="ledger" data-testid="ledger">
  <h2>{{ w.ledger_pixel }}</h2>
  <table class="data sums"><tbody>
    <tr v-for="row in ledger.sources" :key="row.name"><th scope="row">{{ row.name }}</th><td class="number">{{ row.value }}</td></tr>
    <tr class="total"><th scope="row">{{ ledger.mean_name }}</th>
      <td class="number" data-testid="ledger-pixel" :data-exact="JSON.stringify(ledger.exact)">{{ ledger.value }}</td></tr>
  </tbody></table>
  <p :class="ledger.pixel_adds_up ? 'good' : 'warning'" data-testid="ledger-pixel-check">{{ ledger.pixel_check }}</p>
  <h2>{{ ledger.path_name }}</h2>
  <table class="data sums"><tbody>
    <tr v-for="row in ledger.terms" :key="row.step" class="link" :class="{now: row.step === event_index}"
      @click="trigger('event', [row.step])"><th scope="row"><button class="plain">{{ row.name }}</button></th>
      <td class="number"><i class="swatch" :style="{background: row.colour}"></i>{{ row.value }}</td></tr>
    <tr v-if="!ledger.terms.length"><td colspan="2" class="dim">{{ w.ledger_nothing }}</td></tr>
    <tr class="total"><th scope="row">{{ w.ledger_sum }}</th>
      <td class="number" data-testid="ledger-path">{{ ledger.radiance }}</td></tr>
  </tbody></table>
  <p :class="ledger.path_adds_up ? 'good' : 'warning'" data-testid="ledger-path-check">{{ ledger.path_check }}</p>
</div>
"""


def show(session, say):
    """Both sums, with the check that they are exact."""
    record, path = session.record, session.path
    folded = tracer.fold(np.stack([p.radiance for p in record.paths], axis=1))
    pixel_adds_up = bool(np.array_equal(folded, record.value))
    path_adds_up = bool(np.array_equal(total(path), path.radiance))
    return {
        "sources": _sources(record, say),
        "mean_name": say("ledger.mean", n=len(record.paths)),
        "value": several(record.value),
        "exact": [number(v) for v in record.value],
        "pixel_adds_up": pixel_adds_up,
        "pixel_check": say("ledger.exact" if pixel_adds_up else "ledger.differs", other=several(folded)),
        "path_name": say("ledger.path", path=path.sample),
        "terms": [_term(e, say) for e in path.events if np.any(e.values.get("contribution", 0) != 0)],
        "radiance": several(path.radiance),
        "path_adds_up": path_adds_up,
        "path_check": say("ledger.exact" if path_adds_up else "ledger.differs", other=several(total(path))),
    }


def total(path):
    """The contributions of a path added in the order they came, in the path's own precision."""
    added = np.zeros_like(path.radiance)
    for event in path.events:
        if "contribution" in event.values:
            added = added + event.values["contribution"]
    return added


def _sources(record, say):
    """What came how, and at which depth: each row is already divided by the number of samples."""
    sums = {}
    for path in record.paths:
        for event in path.events:
            given = np.asarray(event.values.get("contribution", 0), float)
            if np.any(given != 0):
                key = (event.depth, event.kind.name)
                sums[key] = sums.get(key, 0) + given / len(record.paths)
    return [
        {"name": say(f"ledger.{kind}", depth=depth), "value": several(value)}
        for (depth, kind), value in sorted(sums.items())
    ]


def _term(event, say):
    value = event.values["contribution"]
    name = say(f"ledger.{event.kind.name}", depth=event.depth)
    return {"step": event.step, "name": name, "value": several(value), "colour": css(value)}


PANEL = Panel("ledger", "tab", "path", 30, TEMPLATE, show)
