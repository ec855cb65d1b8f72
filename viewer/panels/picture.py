"""The rendered picture: zoom, hover, pick, fields for x and y, exposure."""

from tracer.recorder import number
from viewer.numerals import several
from viewer.panels.panel import Panel

TEMPLATE = """
<section class="panel picture" :aria-label="w.picture">
  <castray-picture :rgb="rgb" :width="picture.width" :height="picture.height" :x="picture.x" :y="picture.y"
    :exposure="exposure" :label="w.picture_label" :words="w" :overlay="picture.overlay" :overlay-values="overlay_values"
    :rival="rival_rgb" :wipe="wipe" :style="{'--aspect': picture.width / picture.height}" @wipe="wipe = $event" @pick="trigger('pick', $event)"></castray-picture>
  <label v-if="rival_rgb.byteLength" class="row wipe"><span>a</span><input type="range" min="0" max="1" step="0.01" data-testid="wipe" :aria-label="w.wipe" :title="w.wipe"
    :value="wipe" @input="wipe = Number($event.target.value)"><span>b</span></label>
  <p v-if="picture.engine" class="dim engine" role="status" data-testid="engine" :title="picture.engine.title">{{ picture.engine.text }}</p>
  <castray-legend v-if="picture.overlay" :overlay="picture.overlay" :words="w" @close="trigger('uncover')"></castray-legend>
  <div class="row">
    <label>x <input type="number" inputmode="numeric" :min="picture.first[0]" :step="picture.step[0]" :max="picture.width - 1" data-testid="pixel-x"
      :value="picture.x" :aria-label="w.pixel_x" :title="w.pixel_x"
      @change="trigger('pick', [$event.target.value, picture.y]); $event.target.validity.valid || ($event.target.value = picture.x)"></label>
    <label>y <input type="number" inputmode="numeric" :min="picture.first[1]" :step="picture.step[1]" :max="picture.height - 1" data-testid="pixel-y"
      :value="picture.y" :aria-label="w.pixel_y" :title="w.pixel_y"
      @change="trigger('pick', [picture.x, $event.target.value]); $event.target.validity.valid || ($event.target.value = picture.y)"></label>
    <span class="grow"></span>
    <button class="small" data-testid="pixel-back" :disabled="!picture.behind" :aria-label="w.pixel_back" :title="w.pixel_back"
      @click="trigger('back', [-1])"><castray-icon name="back"/></button>
    <button class="small" data-testid="pixel-forward" :disabled="!picture.ahead" :aria-label="w.pixel_forward" :title="w.pixel_forward"
      @click="trigger('back', [1])"><castray-icon name="forward"/></button>
  </div>
  <div class="row" :title="w.pixel_value"><span>RGB</span>
    <output class="rgb" data-testid="pixel-value" :data-exact="JSON.stringify(picture.exact)">{{ picture.value }}</output>
  </div>
  <label class="row" :title="w.exposure_help">{{ w.exposure }}
    <input type="range" min="-8" max="8" step="0.25" data-testid="exposure" :aria-label="w.exposure"
      :value="exposure" @input="exposure = Number($event.target.value)">
    <output class="stops" data-testid="exposure-value">{{ exposure > 0 ? '+' : '' }}{{ exposure }}</output></label>
</section>
"""


def show(session, say):
    """The picked pixel and its value, and what lies over the picture."""
    cursor, record = session.cursor, session.record
    lattice = session.given and session.given.lattice
    return {
        "width": session.settings.width,
        "height": session.settings.height,
        "first": lattice.first if lattice else (0, 0),
        "step": lattice.step if lattice else (1, 1),
        "x": cursor.x,
        "y": cursor.y,
        "value": several(record.value),
        "exact": [number(v) for v in record.value],
        "behind": session.history.behind,
        "ahead": session.history.ahead,
        "overlay": session.overlay and session.overlay.legend(say),
        "engine": _engine(session, say),
    }


def _engine(session, say):
    """Who made the picture, in a line and a tooltip, where gl was asked for; None otherwise."""
    gl = session.shelf.get("gl")
    if gl is None or session.picture is None or session.given is not None:
        return None
    key, told = "engine.gl", {"renderer": gl.renderer}
    if session.picture.engine == "numpy":
        key, told = "engine.numpy", {"why": say.error(session.numpy_why)}
    return {"text": say(key, **told), "title": say(f"{key}.title", **told)}


PANEL = Panel("picture", "left", "pixel", 10, TEMPLATE, show)
