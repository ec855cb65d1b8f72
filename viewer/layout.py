"""The page: where panels stand, as one Vue template."""

from viewer.panels import all_panels

FRAME = """
<castray-tab :owner="owner" :link="link" :x="picture.x" :y="picture.y" :keys="help.keys" :language="language" :languages="languages"><template #default="{mine, take, speak}">
<div class="castray" :class="{reading: lesson.number !== null || tab === 'lesson'}" data-testid="castray" :data-link="link">
  <header>
    <h1><img src="castray/icon.svg" alt="" width="20" height="20"> {{ w.title }}</h1>
    <span class="scene" data-testid="scene">{{ header.scene }}</span>
    <span class="dim settings" data-testid="settings">{{ header.settings }}</span>
    <span class="grow"></span>
    <span v-if="progress" class="progress" role="status" data-testid="progress">{{ progress }}</span>
    <span class="keys" aria-hidden="true"><kbd>←</kbd><kbd>→</kbd> {{ w.hint_events }} <kbd>↑</kbd><kbd>↓</kbd> {{ w.hint_paths }}</span>
    %(header)s
    <select :value="language" :aria-label="w.language" :title="w.language" data-testid="language" @change="speak($event.target.value)">
      <option v-for="l in languages" :key="l.tag" :value="l.tag" :lang="l.tag">{{ l.name }}</option></select>
  </header>
  <aside class="left">%(left)s</aside>
  <section class="stage" id="stage" :aria-label="w.stage" data-testid="stage">%(view)s
    <ul class="marks" :aria-label="w.legend">
      <li><i class="walked"></i>{{ w.legend_walked }}</li><li><i class="ahead"></i>{{ w.legend_ahead }}</li>
      <li><i class="others"></i>{{ w.legend_others }}</li><li><i class="lit">━●</i>{{ w.legend_lit }}</li>
      <li><i class="blocked">╍✕</i>{{ w.legend_blocked }}</li><li><i class="idle">┄</i>{{ w.legend_idle }}</li>
      <li v-if="companions.what_if" data-testid="legend-what-if"><i class="what_if">╍●</i>{{ w.legend_what_if }}</li>
      <li v-if="companions.twin" data-testid="legend-twin"><i class="twin">╍●</i>{{ w.legend_twin }}</li>
      <li v-for="mark in over" :key="mark.kind + mark.text" :data-testid="'legend-' + mark.kind"><i :class="mark.kind"></i>{{ mark.text }}</li>
    </ul>
    <p v-if="!touched && !message" class="hint" data-testid="hint">{{ w.hint }}</p>
  </section>
  <aside class="right">%(right)s
    <div class="tabs" role="tablist" :aria-label="w.tabs">%(tablist)s</div>
    <div class="tabbody" role="tabpanel" tabindex="0" :aria-label="w['tab_' + tab]">%(tabs)s</div>
  </aside>
  <footer>%(below)s</footer>
  <p v-if="message" class="toast" role="alert" data-testid="message">{{ message }}
    <button :aria-label="w.close" data-testid="close-message" @click="trigger('dismiss')">✕</button></p>
  <div v-if="owner && !mine" class="takeover" role="alertdialog" :aria-label="w.taken" data-testid="taken-over"><div>
    <p>{{ w.taken }}</p><button data-testid="take-back" @click="take()">{{ w.take_back }}</button></div></div>
</div></template></castray-tab>
"""
# in the element of the 3D view, whose scene it draws with
LABELS = """
<castray-stage :labels="labels" :camera="camera" :strokes="[...path_strokes, ...event_strokes, ...over_strokes]"><template #default="{home}">
  <button class="home" data-testid="home" :aria-label="w.home" :title="w.home" @click="home()"><castray-icon name="home"/></button>
</template></castray-stage>
"""
TAB = (
    '<button role="tab" :aria-selected="tab === \'{0}\'" :class="{{now: tab === \'{0}\'}}" data-testid="tab-{0}" '
    "@click=\"tab = '{0}'; trigger('look', ['{0}'])\">{{{{ w.tab_{0} }}}}</button>"
)


def template(view):
    """The whole page as a Vue template; view is the element of the 3D view."""
    places = {
        place: [p for p in all_panels() if p.place == place]
        for place in ("header", "left", "right", "tab", "below")
    }
    slots = {place: "".join(p.template for p in panels) for place, panels in places.items() if place != "tab"}
    slots["tablist"] = "".join(TAB.format(p.name) for p in places["tab"])
    slots["tabs"] = "".join(f"<div v-if=\"tab === '{p.name}'\">{p.template}</div>" for p in places["tab"])
    return FRAME % {**slots, "view": view}
