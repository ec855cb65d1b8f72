"""Change and see: materials and lights of the scene, and the settings; the picture follows at once."""

from tracer.scene_file.change import changed
from tracer.settings import ANY_DEPTH
from viewer.panels.panel import Panel
from viewer.tuning import dials, knobs, tuned, turned

MOST = 40  # knobs on the page; the others are turned by --set

TEMPLATE = """
<div class="change" data-testid="change">
  <div class="row"><span class="grow">{{ change.note }}</span>
    <button data-testid="change-reset" :disabled="!change.changed" @click="trigger('change_reset')">{{ w.change_reset }}</button></div>
  <h2 v-if="change.knobs.length">{{ w.change_scene }}</h2>
  <castray-knob v-for="knob in change.knobs" :key="knob.key" :knob="knob" call="change"></castray-knob>
  <p v-if="change.more" class="dim">{{ change.more }}</p>
  <h2>{{ w.change_settings }}</h2>
  <castray-knob v-for="dial in change.dials" :key="dial.key" :knob="dial" call="tune"></castray-knob>
  <template v-if="change.changed"><h2>{{ w.change_command }}</h2>
    <castray-command data-testid="change-command" :text="change.command"></castray-command></template>
</div>
"""


def show(session, say):
    """Knobs with their labels, and the words that say the same to the command."""
    found = knobs(session.scene)
    changes = session.scene.definition.changes
    return {
        "knobs": [_shown(knob, say) for knob in found[:MOST]],
        "more": say("change.more", n=len(found) - MOST) if len(found) > MOST else "",
        "dials": [_dial(dial, say) for dial in dials(session.settings)],
        "changed": bool(changes) or session.settings != session.at_start,
        "note": say("change.note", n=len(changes)) if changes else say("change.none"),
        "command": session.command,
    }


def _shown(knob, say):
    name, _, _ = knob.key.rpartition(".")
    label = say(f"change.{knob.meaning}", name=name.removesuffix(".emitter").removesuffix(".bsdf"))
    kind = "choice" if knob.choices else "range"
    choices = [{"value": c, "text": c} for c in knob.choices]
    return knob.shown() | {"label": label, "title": knob.key, "kind": kind, "choices": choices}


def _dial(dial, say):
    name = dial["name"]
    choices = [{"value": c, "text": say.dialed(c) if c else say("value.none")} for c in dial["choices"]]
    kind = "choice" if choices else "number" if isinstance(dial["value"], int) else "text"
    return {
        "key": name,
        "label": say.dial(name),
        "title": f"--{name.replace('_', '-')}: {say.setting(name)}",
        "value": "" if name == "max_depth" and dial["value"] == ANY_DEPTH else dial["value"],
        "choices": choices,
        "kind": kind,
        "note": say.optional(f"dialed.{dial['value']}", "") if kind == "number" else "",
    }


def calls(window):
    """What the panel may ask for."""
    session = window.session

    def change(key, value):
        window.alter(changed(session.scene, turned(session.scene, key, value)), session.settings)

    def tune(name, value):
        window.alter(session.scene, tuned(session.settings, name, value))

    def change_reset():
        window.alter(changed(session.scene, {}), session.at_start)

    return {"change": change, "tune": tune, "change_reset": change_reset}


PANEL = Panel("change", "tab", "path", 40, TEMPLATE, show, calls)
