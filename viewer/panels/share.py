"""Share: the moment as a link, and files of it to take along."""

import shlex

from tracer.trace.folder import view_command as of_recording
from viewer import examining
from viewer.checking.learner import said
from viewer.panels.panel import Panel
from viewer.replay import of_scene, opening, serving
from viewer.sharing.files import FILES

TEMPLATE = """
<details class="menu" data-testid="share" @keydown.esc="$event.currentTarget.open = false"><summary>{{ w.share }}</summary><div>
  <p class="dim">{{ share.local ? w.share_file_about : w.share_link_about }}</p>
  <castray-copy :text="share.command || link" :words="w"></castray-copy>
  <p v-if="!share.command" class="dim">{{ w.share_here_only }}</p>
  <ul><li v-for="f in share.files" :key="f.name"><a :href="'share/' + f.name" download :data-testid="'share-' + f.name" :title="f.title">{{ f.label }}</a></li></ul>
</div></details>
"""


def show(session, say):
    """The command that opens this moment anywhere, and the files there are."""
    c, takes = session.cursor, {"seconds": examining.seconds(session.settings)}
    files = [
        {"name": name, "label": say(f"share.{name}", **takes), "title": say(f"share.{name}.title")}
        for name in FILES
        if name != "doctor.html" or session.recording is None or session.recording.kinds
    ]
    local = session.given is not None or session.recording is not None
    if session.given is not None:
        command = session.given.opening((c.x, c.y, c.path, c.event))
    elif session.recording is not None:
        command = of_recording(session.recording.path, (c.x, c.y, session.path.sample, c.event))
    else:
        command = opening(session.link) or ""
    return {"command": command, "again": _again(session, command), "files": files, "local": local}


def _again(session, command):
    """What starts the viewer again after it has ended: the moment's command with what no link says. What came
    from the page lies nowhere, and is left out."""
    watched, gl, against = session.shelf.get("watched"), session.shelf.get("gl"), session.against
    if watched is not None and session.given is None:
        command = f"castray view {of_scene(watched.file, watched.scene)}{said(watched.settings)}"
    elif not command:
        known = session.scene.name not in session.uploaded
        changes = session.scene.definition.changes
        command = serving(session.scene.name, session.settings, changes) if known else "castray view"
    rival = session.rivals.get(against)
    if against and (rival.data is None if rival else not command.startswith("castray view '#")):
        command += f" --compare {shlex.quote(against)}"
    return command + (f" --engine {gl.asked}" if gl is not None else "")


PANEL = Panel("share", "header", "event", 10, TEMPLATE, show)
