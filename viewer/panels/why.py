"""Why: reasons for the picked pixel's value in sentences, each leading to an event that shows it."""

from viewer.panels.panel import Panel
from viewer.understanding.why import why

TEMPLATE = """
<div v-if="why" class="why" data-testid="why"><div class="between"><h2>{{ why.head }}</h2>
    <button data-testid="why-doctor" :title="w.why_doctor_help" @click="tab = 'doctor'; trigger('look', ['doctor']); trigger('doctor_examine')">{{ w.why_doctor }}</button></div>
  <ol class="reasons" :aria-label="w.why_reasons"><li v-for="(r, k) in why.reasons" :key="k" :class="{strange: r.strange}">
    <button class="plain" :data-testid="'reason-' + k" :data-key="r.key" :data-count="r.count" :disabled="!r.place" :title="r.see" @click="trigger('at', r.place)">{{ r.sentence }}</button></li></ol>
  <template v-if="why.command"><h2>{{ w.change_command }}</h2><castray-command data-testid="why-command" :text="why.command"></castray-command></template>
</div>
"""


def show(session, say):
    """Every reason with its place."""
    return {
        "head": say("why.head", x=session.cursor.x, y=session.cursor.y),
        "reasons": [_row(r, say) for r in why(session.record, session.scene, session.given is None)],
        "command": "" if session.given else session.why_command,
    }


def _row(reason, say):
    path, event = reason.place or (None, None)
    return {
        "key": reason.key,
        "sentence": reason.sentence(say),
        "count": reason.count,
        "strange": reason.strange,
        "place": reason.place and list(reason.place),
        "see": say("why.see", path=path, event=event) if reason.place else "",
    }


PANEL = Panel("why", "tab", "pixel", 35, TEMPLATE, show, lazy=True)
