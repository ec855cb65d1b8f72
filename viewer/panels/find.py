"""Find: the paths of the whole picture that did something, where they are, and what stands out."""

from tracer.settings import TracerError
from tracer.trace.breakpoints import BREAKPOINTS
from viewer.finding import maps, survey
from viewer.finding.finder import SHOWN, Desk, Finder
from viewer.numerals import short
from viewer.panels.panel import Panel
from viewer.worker import Worker

EXAMPLES = (
    "depth >= 2 AND luminance(contribution) > 1",
    "kind = 'light' AND NOT visible AND blocker = shape",
    "dot(n, wi) < 0",
    "kind = 'bounce' AND pdf < 0.01",
    "reason = 'roulette' AND depth > 8",
    "SELECT kind, count(*) AS events FROM events GROUP BY kind ORDER BY events DESC",
)

TEMPLATE = """
<div class="find" data-testid="find"><p v-if="find.foreign" class="dim" data-testid="find-foreign">{{ find.foreign }}</p><template v-else>
  <castray-query :text="find.text" :examples="find.examples" :invalid="!!find.error" :words="w" @ask="trigger('find', [$event])"></castray-query>
  <div class="chips" role="group" :aria-label="w.find_stops">
    <button v-for="s in find.stops" :key="s.name" :data-testid="'stop-' + s.name" :title="s.title" @click="trigger('find_stop', [s.name])">{{ s.label }}</button></div>
  <p class="status dim" role="status" data-testid="find-status"><span v-if="find.busy" class="busy" aria-hidden="true"></span>{{ find.status }}
    <button v-if="find.can_prepare" data-testid="find-prepare" @click="trigger('find_prepare')">{{ find.recording ? w.find_look : w.find_prepare }}</button></p>
  <div v-if="find.error" class="warning" role="alert" data-testid="find-error">{{ find.error.words }}
    <pre v-if="find.error.at !== null" data-testid="find-caret" :data-at="find.error.at">{{ find.error.before }}<mark>{{ find.error.marked }}</mark>{{ find.error.after }}</pre>
    <details v-if="find.error.names.length"><summary>{{ w.find_columns }}</summary><code class="names">{{ find.error.names.join('  ') }}</code></details></div>
  <section v-if="find.found" data-testid="find-found" :data-paths="find.found.paths" :data-events="find.found.events" :data-pixels="find.found.pixels">
    <div class="between"><p data-testid="find-count">{{ find.found.said }}</p>
      <span v-if="find.found.rows.length" class="steps"><button class="small" data-testid="hit-previous" :aria-label="w.hit_previous" :title="w.hit_previous" @click="trigger('find_step', [-1])"><castray-icon name="up"/></button>
      <button class="small" data-testid="hit-next" :aria-label="w.hit_next" :title="w.hit_next" @click="trigger('find_step', [1])"><castray-icon name="down"/></button></span></div>
    <ol v-if="find.found.rows.length" class="hits" :aria-label="w.find_hits" data-testid="hits"><li v-for="(row, k) in find.found.rows" :key="k">
      <button :data-testid="'hit-' + k" :aria-current="k === find.found.hit ? 'true' : null" :class="{now: k === find.found.hit}" @click="trigger('find_hit', [k])">
        <span class="number">{{ row.pixel }}</span><span>{{ row.path }}</span><span class="dim">{{ row.event }}</span></button></li></ol>
    <p v-if="find.found.more" class="dim">{{ find.found.more }}</p></section>
  <section v-if="find.table" class="scroll" data-testid="find-table"><table class="rows"><thead><tr><th v-for="c in find.table.columns" :key="c" scope="col">{{ c }}</th></tr></thead>
    <tbody><tr v-for="(row, k) in find.table.rows" :key="k"><td v-for="(v, j) in row" :key="j" class="number">{{ v }}</td></tr></tbody></table>
    <p v-if="find.table.more" class="dim">{{ find.table.more }}</p></section>
  <label class="row pick"><span>{{ w.find_map }}</span><select data-testid="map" :value="find.map" @change="trigger('find_map', [$event.target.value])">
    <option value="">{{ w.find_no_map }}</option><option v-for="m in find.maps" :key="m.name" :value="m.name">{{ m.label }}</option></select></label>
  <section v-if="find.histogram"><h2>{{ find.histogram.title }}</h2>
    <castray-histogram :bins="find.histogram.bins" :low="find.histogram.low" :high="find.histogram.high" :words="w" @brush="trigger('find_brush', $event)"></castray-histogram></section>
  <section v-if="find.fireflies"><h2>{{ w.fireflies }}</h2>
    <p v-if="!find.fireflies.length" class="dim" data-testid="no-fireflies">{{ w.fireflies_none }}</p>
    <ol v-if="find.fireflies.length" class="hits" :aria-label="w.fireflies" data-testid="fireflies"><li v-for="(row, k) in find.fireflies" :key="k"><button :data-testid="'firefly-' + k"
      @click="trigger('find_firefly', [k])"><span class="number">{{ row.pixel }}</span><span>{{ row.path }}</span><span class="dim">{{ row.said }}</span></button></li></ol></section>
</template></div>
"""


def calls(window):
    """What this panel's page may ask for."""
    finder = Finder(window, Worker(window.back), Worker(window.back))
    return {
        "find": finder.ask,
        "find_stop": finder.stop_at,
        "find_prepare": finder.prepare,
        "find_hit": finder.hit,
        "find_step": finder.step,
        "find_map": finder.show_map,
        "find_brush": finder.brushed,
        "find_firefly": finder.firefly,
    }


def show(session, say):
    """What lies on the finder's desk."""
    desk = session.desk.get("find") or Desk()
    there = desk.survey
    stops = [
        {"name": name, "label": say(f"stop.{name}"), "title": f"{say(f'stop.{name}.title')}\n{b.events}"}
        for name, b in BREAKPOINTS.items()
    ]
    return {
        "foreign": say("find.foreign", name=session.given.name) if session.given else "",
        "recording": session.recording is not None,
        "text": desk.text,
        "examples": list(EXAMPLES),
        "stops": stops,
        "busy": desk.asking or desk.looking or desk.tracing is not None,
        "status": _status(session, desk, say),
        "can_prepare": there is None and desk.tracing is None,
        "error": desk.error and _error(desk, say),
        "found": _found(desk, say) if desk.answer and "found" in desk.answer else None,
        "table": _table(desk, say) if desk.answer and "rows" in desk.answer else None,
        "maps": [{"name": m, "label": say(f"map.{m}")} for m in maps.known(there or session.settings)],
        "map": _map(session.overlay),
        "histogram": desk.histogram and _histogram(desk, say),
        "fireflies": _fireflies(desk, say) if desk.histogram or desk.fireflies else None,
    }


def _map(laid):
    """The heat map that lies over the picture, "" for none."""
    return laid.title.removeprefix("map.") if laid and laid.title.startswith("map.") else ""


def _status(session, desk, say):
    """What is asked, or what will be, in one line."""
    if desk.tracing is not None:
        return say("find.tracing", percent=round(100 * desk.tracing))
    if desk.asking:
        return say("find.asking")
    if desk.survey:
        few = desk.survey.settings
        key = "find.recorded" if desk.survey.kept is None else "find.traced"
        return say(key, paths=desk.survey.paths, spp=few.spp, seconds=short(round(desk.survey.seconds, 1)))
    if session.recording:
        return say("find.recording")
    try:
        few = survey.planned(session.settings)
    except TracerError as error:
        return say.error(str(error))
    paths = survey.paths_of(few)
    seconds = max(1, round(paths * (session.pace or survey.PACE) * survey.RECORDING))
    return say("find.would", paths=paths, spp=few.spp, seconds=seconds)


def _error(desk, say):
    """What is wrong with the query, and where."""
    error, text = desk.error, desk.text
    at = getattr(error, "at", None)
    words = say.error(getattr(error, "words", str(error)))  # the columns there are stand below
    words = words if at is None else say("find.error", at=at + 1, words=words)
    end = at if at is None else at + max(1, len(_word(text[at:])))
    return {
        "words": words,
        "at": at,
        "before": text[:at] if at is not None else "",
        "marked": text[at:end] or "␣" if at is not None else "",
        "after": text[end:] if at is not None else "",
        "names": list(getattr(error, "names", ())),
    }


def _word(text):
    """The word that a text begins with."""
    end = next((k for k, c in enumerate(text) if not (c.isalnum() or c in "_.")), len(text))
    return text[:end]


def _found(desk, say):
    answer = desk.answer
    rows = [
        {
            "pixel": f"{p['x']}, {p['y']}",
            "path": say("find.path", path=p["sample"]),
            "event": _event(p, say),
        }
        for p in answer["found"]
    ]
    counts = {name: answer[name] for name in ("events", "paths", "pixels")}
    said = say("find.count", **counts) if answer["paths"] else say("find.nothing")
    more = answer["paths"] - len(rows)
    return {
        "rows": rows,
        "hit": desk.hit,
        "said": said,
        "more": say("find.more", n=more) if more else "",
        **counts,
    }


def _event(path, say):
    if path["kind"] is None:
        return ""
    return say("find.event", kind=say(f"kind.{path['kind']}"), depth=path["depth"], step=path["step"])


def _table(desk, say):
    answer = desk.answer
    rows = [["–" if v is None else _cell(v) for v in row] for row in answer["rows"]]
    more = say("find.more_rows", n=SHOWN) if answer["more"] else ""
    return {"columns": answer["columns"], "rows": rows, "more": more}


def _cell(value):
    if isinstance(value, float):
        return short(value)
    if isinstance(value, dict):
        return "  ".join(_cell(v) for v in value.values())
    return str(value)


def _histogram(desk, say):
    one = desk.histogram
    bins = [
        {"low": low, "high": high, "count": count}
        for low, high, count in zip(one.edges[:-1], one.edges[1:], one.counts, strict=True)
    ]
    low, high = desk.brush or (-1, -1)
    title = "find.histogram" if "contribution" in one.of else "find.histogram_paths"
    return {"title": say(title, n=sum(one.counts)), "bins": bins, "low": low, "high": high}


def _fireflies(desk, say):
    return [
        {
            "pixel": f"{f['x']}, {f['y']}",
            "path": say("find.path", path=f["sample"]),
            "said": say("find.firefly", luminance=short(f["luminance"]), around=short(f["around"])),
        }
        for f in desk.fireflies
    ]


PANEL = Panel("find", "tab", "picture", 40, TEMPLATE, show, calls)
