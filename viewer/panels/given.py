"""What is shown in place of castray's own paths: a learner's tracer that runs when it is saved, or a log."""

from viewer.panels.panel import Panel

TEMPLATE = """
<section v-if="given" class="panel given" :aria-label="w.given" data-testid="given" :data-runs="given.runs" :data-shown="given.shown">
  <p role="status"><span v-if="given.busy" class="busy" aria-hidden="true"></span><b>{{ given.name }}</b> <span class="dim" data-testid="given-said">{{ given.said }}</span></p>
  <p v-if="given.error" class="warning" role="alert" data-testid="given-error">{{ given.error }}</p>
  <p v-if="given.away"><button data-testid="given-show" @click="trigger('given_show')">{{ w.given_show }}</button></p>
</section>
"""


def show(session, say):
    """What is given, and what became of the last run."""
    watched, given = session.shelf.get("watched"), session.given
    if watched is None and given is None:
        return None
    name = watched.name if watched else given.name
    busy, error = (watched.busy, watched.error) if watched else (False, None)
    return {
        "name": name,
        "busy": busy,
        "runs": watched.runs if watched else 0,
        "shown": given is not None,
        "said": _said(watched, given, say),
        "error": say.error(str(error)) if error else "",
        "away": watched is not None and watched.good is not None and given is None,
    }


def _said(watched, given, say):
    """In one line what is seen and what goes on."""
    words = [say("given.running")] if watched and watched.busy else []
    if given is None:
        return say.sentences(*words, say("given.own"))
    found, paths = len(given.chart.diagnosis.causes), given.trace.size
    seen = say("given.findings", n=found, paths=paths) if found else say("given.clean", paths=paths)
    words.append(seen)
    if given.lattice is not None:
        words.append(say("given.lattice", columns=given.lattice.step[0], rows=given.lattice.step[1]))
    if watched and watched.error:
        words.append(say("given.last_good"))
    return say.sentences(*words)


def calls(window):
    """What this panel's page may ask for."""

    def given_show():
        watched = window.session.shelf.get("watched")
        if watched is not None and watched.good is not None:
            window.give(watched.good)

    return {"given_show": given_show}


PANEL = Panel("given", "left", "picture", 5, TEMPLATE, show, calls)
