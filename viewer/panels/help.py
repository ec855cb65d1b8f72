"""What can be done here: keys, mouse and the marks of the 3D view."""

from viewer.panels.panel import Panel

KEYS = (
    "arrows",
    "paths",
    "ends",
    "space",
    "shift",
    "picked",
    "hits",
    "differs",
    "lobes",
    "lesson",
    "question",
)

TEMPLATE = """
<div class="help" data-testid="help">
  <p>{{ w.help_intro }}</p>
  <table class="keys"><tbody><tr v-for="row in help.keys" :key="row.key"><th scope="row"><kbd>{{ row.key }}</kbd></th><td>{{ row.text }}</td></tr></tbody></table>
  <p>{{ w.help_picture }}</p><p>{{ w.help_stage }}</p><p>{{ w.help_link }}</p>
</div>
"""


def show(session, say):
    """The keys and what they do."""
    return {"keys": [{"key": say(f"key.{k}"), "text": say(f"key.{k}.does")} for k in KEYS]}


PANEL = Panel("help", "tab", "picture", 90, TEMPLATE, show)
