"""The ledger: a waterfall of the pixel by depth and technique, and a path's contributions; both add up."""

import numpy as np

from tracer.recorder import number
from viewer.numerals import css, luminance, several
from viewer.panels.panel import Panel
from viewer.understanding.waterfall import bar_name, carried

TEMPLATE = """
<div class="ledger" data-testid="ledger">
  <h2>{{ w.ledger_pixel }}</h2>
  <ol class="fall" :aria-label="w.ledger_pixel" data-testid="waterfall">
    <li v-for="bar in ledger.bars" :key="bar.name" :class="bar.kind"><button class="plain" :data-testid="'bar-' + bar.key" :data-exact="JSON.stringify(bar.exact)"
      :disabled="!bar.place" :title="bar.title" @click="trigger('at', bar.place)"><span>{{ bar.name }}</span><span class="number">{{ bar.value }}</span>
      <i class="track" aria-hidden="true"><i class="bar" :class="{below: bar.below}" :style="{left: bar.left + '%', width: bar.width + '%', background: bar.colour}"></i><i class="zero" :style="{left: ledger.zero + '%'}"></i></i></button></li>
    <li class="total"><span>{{ ledger.mean_name }}</span><span class="number" data-testid="ledger-pixel" :data-exact="JSON.stringify(ledger.exact)">{{ ledger.value }}</span></li>
  </ol>
  <p :class="ledger.pixel_adds_up ? 'good' : 'warning'" data-testid="ledger-pixel-check">{{ ledger.pixel_check }}</p>
  <h2>{{ ledger.path_name }}</h2>
  <table class="data sums"><tbody>
    <tr v-for="row in ledger.terms" :key="row.step" class="link" :class="{now: row.step === event_index}"
      @click="trigger('event', [row.step])"><th scope="row"><button class="plain">{{ row.name }}</button></th>
      <td class="number"><i v-if="row.colour" class="swatch" :style="{background: row.colour}"></i>{{ row.value }}</td></tr>
    <tr v-if="!ledger.terms.length"><td colspan="2" class="dim">{{ w.ledger_nothing }}</td></tr>
    <tr class="total"><th scope="row">{{ w.ledger_sum }}</th>
      <td class="number" data-testid="ledger-path">{{ ledger.radiance }}</td></tr>
  </tbody></table>
  <p :class="ledger.path_adds_up ? 'good' : 'warning'" data-testid="ledger-path-check">{{ ledger.path_check }}</p>
</div>
"""
LEAST = 0.6  # percent of the track that a bar takes at least, to be seen


def show(session, say):
    """Both sums, with the check that they are exact."""
    record, path = session.record, session.path
    bars = session.waterfall
    shown, zero = _drawn(bars, say)
    pixel = [float(sum(bar.value[c] for bar in bars)) for c in range(3)]
    pixel_adds_up = bool(np.array_equal(pixel, record.value.astype(float)))
    path_adds_up = bool(np.array_equal(carried(path), path.radiance))
    return {
        "bars": shown,
        "zero": zero,
        "mean_name": say("ledger.mean", n=len(record.paths)),
        "value": several(record.value),
        "exact": [number(v) for v in record.value],
        "pixel_adds_up": pixel_adds_up,
        "pixel_check": say("ledger.exact" if pixel_adds_up else "ledger.differs", other=several(pixel)),
        "path_name": say("ledger.path", path=path.sample),
        "terms": [_term(e, say) for e in path.events if np.any(e.values.get("contribution", 0) != 0)],
        "radiance": several(path.radiance),
        "path_adds_up": path_adds_up,
        "path_check": say("ledger.exact" if path_adds_up else "ledger.differs", other=several(carried(path))),
    }


def _drawn(bars, say):
    """The bars, each beginning where the one before ends, in percent of the track, and where 0 lies there."""
    ends = np.cumsum([0.0, *(luminance([float(v) for v in bar.value]) for bar in bars)])
    low, high = ends.min(), ends.max()
    scale = 100.0 / (high - low) if high > low else 0.0
    rows = []
    for bar, before, after in zip(bars, ends[:-1], ends[1:], strict=True):
        value = np.array([float(v) for v in bar.value])
        rows.append(
            {
                "key": bar.kind if bar.depth is None else f"{bar.kind}-{bar.depth}",
                "kind": bar.kind,
                "name": bar_name(bar, say),
                "title": say("ledger.largest", n=bar.events) if bar.place else "",
                "value": several(value),
                "exact": value.tolist(),
                "place": bar.place and list(bar.place),
                "below": bool(after < before),
                "left": float(min(before, after) - low) * scale,
                "width": max(
                    float(abs(after - before)) * scale, LEAST if bar.events and value.any() else 0.0
                ),
                "colour": css(value / value.max()) if value.max() > 0 else "",
            }
        )
    return rows, float(-low * scale)


def _term(event, say):
    value = event.values["contribution"]
    name = say(f"ledger.{event.kind.name}", depth=event.depth)
    colour = css(value) if np.isfinite(value).all() else ""
    return {"step": event.step, "name": name, "value": several(value), "colour": colour}


PANEL = Panel("ledger", "tab", "path", 30, TEMPLATE, show)
