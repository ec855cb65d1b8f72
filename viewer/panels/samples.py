"""The pixel's samples as bars: which paths made it bright."""

from viewer.numerals import css, luminance, short
from viewer.panels.panel import Panel

TEMPLATE = """
<section class="panel samples" :aria-label="w.samples">
  <h2>{{ w.samples }} <span class="dim">{{ samples.note }}</span></h2>
  <castray-bars :bars="samples.bars" :colours="samples.colours" :mean="samples.mean" :selected="path_index"
    :label="w.samples_label" @select="trigger('path', [$event])"></castray-bars>
</section>
"""


def show(session, say):
    """One bar a path: its luminance and colour."""
    bars = [luminance(path.radiance) for path in session.record.paths]
    dead = sum(bar <= 0 for bar in bars)
    return {
        "bars": bars,
        "colours": [css(path.radiance) for path in session.record.paths],
        "mean": luminance(session.record.value),
        "note": say("samples.note", n=len(bars), dead=dead, most=short(max(bars))),
    }


PANEL = Panel("samples", "left", "pixel", 20, TEMPLATE, show)
