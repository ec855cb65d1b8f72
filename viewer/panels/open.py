"""Open: the scenes that come with castray, and files of one's own."""

import tracer
from viewer.opening.uploads import LARGEST, MEGABYTE
from viewer.panels.panel import Panel

TEMPLATE = """
<castray-open :kinds="open_menu.kinds" :words="w" :limits="open_menu.limits"><ul class="scenes" :aria-label="w.open_scenes"><li v-for="s in open_menu.scenes" :key="s">
  <button :data-testid="'open-' + s" :aria-current="s === header.scene ? 'true' : null" @click="trigger('open', ['scene=' + s])">{{ s }}</button></li></ul></castray-open>
"""


def show(session, say):
    """The scenes, and which files may be sent."""
    sizes = {}
    for ending, size in LARGEST.items():
        sizes.setdefault(size // MEGABYTE, []).append(ending)
    limits = [say("open.limit", kinds=say.listed(*kinds), size=size) for size, kinds in sizes.items()]
    return {"scenes": list(tracer.built_in_scenes()), "kinds": ",".join(LARGEST), "limits": limits}


PANEL = Panel("open_menu", "header", "picture", 5, TEMPLATE, show)
