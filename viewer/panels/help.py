"""What can be done here: keys, mouse and the marks of the 3D view, as a dialog over the page."""

from viewer.panels.panel import Panel

# Every key that the page hears, by the words that tell of it: {key: (call, arguments...)}. `beside` picks the
# pixel that is so far away and `help` opens this dialog: the page does both; all others are calls to the server.
KEYS: dict[str, dict[str, tuple]] = {
    "arrows": {"ArrowLeft": ("go", "previous"), "ArrowRight": ("go", "next")},
    "paths": {"ArrowUp": ("go", "up"), "ArrowDown": ("go", "down")},
    "ends": {"Home": ("go", "first"), "End": ("go", "last")},
    "space": {" ": ("play",)},
    "shift": {
        "Shift+ArrowLeft": ("beside", -1, 0),
        "Shift+ArrowRight": ("beside", 1, 0),
        "Shift+ArrowUp": ("beside", 0, -1),
        "Shift+ArrowDown": ("beside", 0, 1),
    },
    "picked": {"[": ("back", -1), "]": ("back", 1)},
    "hits": {"n": ("find_step", 1), "p": ("find_step", -1)},
    "differs": {"d": ("compare_part",)},
    "lobes": {"h": ("lobes",)},
    "lesson": {"l": ("look", "lesson")},
    "question": {"?": ("help",)},
}

TEMPLATE = """
<button data-testid="help-open" aria-haspopup="dialog" :aria-label="w.help" :title="w.help_title" @click="helped = true">?</button>
<castray-help :open="helped" :words="w" @shut="helped = false">
  <p>{{ w.help_intro }}</p>
  <table class="keys"><tbody><tr v-for="row in help.rows" :key="row.key"><th scope="row"><kbd>{{ row.key }}</kbd></th><td>{{ row.text }}</td></tr></tbody></table>
  <p>{{ w.help_picture }}</p><p>{{ w.help_stage }}</p><p>{{ w.help_link }}</p>
</castray-help>
"""


def show(session, say):
    """The keys in words, and what each of them calls."""
    rows = [{"key": say(f"key.{name}"), "text": say(f"key.{name}.does")} for name in KEYS]
    calls = {key: list(call) for group in KEYS.values() for key, call in group.items()}
    return {"rows": rows, "keys": calls}


PANEL = Panel("help", "header", "picture", 20, TEMPLATE, show)
