"""Compare: this picture, a, beside another one, b; and the selected path beside its twin."""

from pathlib import Path

from lessons.zoo import FAMILIES
from tracer.recorder import number
from viewer import diff
from viewer.comparing import maps
from viewer.comparing.comparer import WIPE, Comparer, beside, desk_of
from viewer.comparing.twins import MOST_PATHS
from viewer.examining import planned
from viewer.link import RIGHT
from viewer.numerals import several, short
from viewer.panels.panel import Panel
from viewer.twin_words import all_that_differs, event_of, range_of, told_apart, what_differs
from viewer.worker import Worker
from viewer.zoo import title_of

TEMPLATE = """
<div class="compare" data-testid="compare">
  <label class="row pick"><span>{{ w.compare_with }}</span><select data-testid="rival" :value="compare.against" @change="trigger('compare', [$event.target.value])">
    <option value="">{{ w.compare_nothing }}</option>
    <optgroup v-for="g in compare.choices" :key="g.name" :label="g.name"><option v-for="c in g.members" :key="c.name" :value="c.name">{{ c.label }}</option></optgroup></select></label>
  <p v-if="!compare.against" class="dim">{{ w.compare_intro }}</p>
  <p v-if="compare.error" class="warning" role="alert" data-testid="compare-error">{{ compare.error }}</p>
  <template v-if="compare.against">
  <div class="chips" role="group" :aria-label="w.compare_view"><button v-for="v in compare.views" :key="v.name" :aria-pressed="v.name === compare.view" :class="{now: v.name === compare.view}"
    :data-testid="'view-' + (v.name || 'alone')" :title="v.title" @click="trigger('compare_view', [v.name])">{{ v.label }}</button></div>
  <table class="data sums" data-testid="compare-pixel"><tbody><tr v-for="row in compare.pixel" :key="row.name"><th scope="row">{{ row.name }}</th>
    <td class="number" :data-testid="'compare-' + row.key" :data-exact="JSON.stringify(row.exact)">{{ row.value }}</td></tr></tbody></table>
  <template v-if="compare.verdict"><p :class="{good: compare.verdict.equal}" data-testid="compare-verdict">{{ compare.verdict.said }}
    <button v-if="!compare.verdict.equal" class="small" data-testid="compare-worst" @click="trigger('pick', compare.verdict.worst)">{{ w.compare_worst }}</button></p>
  <details><summary>{{ w.compare_numbers }}</summary><table class="data sums" data-testid="compare-numbers" :data-exact="JSON.stringify(compare.verdict.exact)"><tbody>
    <tr v-for="row in compare.verdict.rows" :key="row.name"><th scope="row">{{ row.name }}</th><td class="number">{{ row.value }}</td></tr></tbody></table>
  <p v-for="note in compare.verdict.notes" :key="note" class="dim">{{ note }}</p></details></template>
  <h2>{{ w.compare_twin }}</h2>
  <p v-if="compare.untwinned" class="dim" data-testid="compare-untwinned">{{ compare.untwinned }}</p>
  <template v-if="compare.twin"><p data-testid="compare-parting" :data-step="compare.twin.step">{{ compare.twin.said }}</p>
  <p v-if="compare.twin.parts"><button data-testid="compare-go" @click="trigger('compare_part')">{{ w.compare_go }}</button></p>
  <table v-if="compare.twin.numbers.length" class="rows both" data-testid="compare-fields"><thead><tr><td></td><th scope="col">a</th><th scope="col">b</th></tr></thead><tbody>
    <tr v-for="row in compare.twin.numbers" :key="row.name" :title="row.meaning"><th scope="row"><code>{{ row.name }}</code></th><td class="number">{{ row.a }}</td><td class="number">{{ row.b }}</td></tr></tbody></table></template>
  <template v-if="compare.paths"><p data-testid="compare-paths" :data-differing="compare.paths.differing">{{ compare.paths.said }}</p>
  <ol v-if="compare.paths.rows.length" class="hits" :aria-label="w.compare_paths"><li v-for="(row, k) in compare.paths.rows" :key="k"><button :data-testid="'parting-' + k" :class="{now: row.now}"
    :aria-current="row.now ? 'true' : null" @click="trigger('compare_path', [k])"><span class="number">{{ row.path }}</span><span>{{ row.event }}</span><span class="dim">{{ row.what }}</span></button></li></ol></template>
  <template v-if="compare.whole"><div class="between"><h2>{{ w.compare_whole }}</h2>
    <button data-testid="compare-search" :disabled="compare.whole.busy" @click="trigger('compare_search')">{{ w.compare_search }}</button></div>
  <p class="dim" role="status"><span v-if="compare.whole.busy" class="busy" aria-hidden="true"></span>{{ compare.whole.said }}</p>
  <ol v-if="compare.whole.causes.length" class="hits causes" :aria-label="w.compare_whole" data-testid="compare-causes"><li v-for="(c, k) in compare.whole.causes" :key="k">
    <button :data-testid="'cause-' + k" :data-pairs="c.pairs" :data-what="c.key" :title="w.compare_cause" @click="trigger('compare_cause', [k])"><span class="number">{{ c.pairs }}</span><span>{{ c.event }}</span><span class="dim">{{ c.what }}</span></button></li></ol></template>
  </template>
</div>
"""


def calls(window):
    """What this panel's page may ask for."""
    comparer = Comparer(window, Worker(window.back))
    return {
        "compare": comparer.choose,
        "compare_view": comparer.look,
        "compare_part": comparer.part,
        "compare_path": comparer.go,
        "compare_search": comparer.search,
        "compare_cause": comparer.cause,
    }


def show(session, say):
    """Both pixels, the verdict on both pictures, and where the selected path parts from its twin."""
    desk = desk_of(session)
    shown_ = {"against": session.against, "choices": _choices(session, say), "error": "", "views": []}
    shown_ |= {
        "view": "",
        "pixel": [],
        "verdict": None,
        "untwinned": "",
        "twin": None,
        "paths": None,
        "whole": None,
    }
    if desk is None:
        return shown_
    there = beside(session)
    shown_["error"] = say.error(str(desk.error)) if desk.error else ""
    shown_["views"], shown_["view"] = _views(desk, say), _view(session, desk)
    shown_["pixel"] = _pixel(session, desk, say)
    if desk.verdict is not None:
        shown_["verdict"] = _verdict(desk, say)
    if desk.twin is None:
        shown_["untwinned"] = say.error(str(desk.untwinned)) if desk.untwinned else say("compare.no_paths")
        return shown_
    more = {"paths": _paths(session, desk, say), "whole": _whole(session, desk, say)}
    return shown_ | {"twin": _twin(there, desk, say)} | more


def _choices(session, say):
    """What can be compared with, in groups."""
    files = [{"name": name, "label": Path(name).name} for name in session.rivals]
    groups = [{"name": say("compare.files"), "members": files}] if files else []
    groups.append(
        {"name": say("compare.tracers"), "members": [{"name": RIGHT, "label": say("compare.right")}]}
    )
    for family, members in FAMILIES.items():
        bugs = [{"name": bug.id, "label": f"{bug.id}  {title_of(bug, say)}"} for bug in members]
        groups.append({"name": say.optional(f"family.{family}", family), "members": bugs})
    return groups


def _views(desk, say):
    there = () if desk.verdict is None else (WIPE, *maps.possible(desk.verdict))
    return [
        {"name": name, "label": say(f"compare.{name or 'alone'}"), "title": say(f"compare.{name or 'alone'}.title")}
        for name in ("", *there)
    ]  # fmt: skip


def _view(session, desk):
    """Which view is seen."""
    laid = session.overlay
    if laid is not None:
        return laid.title.removeprefix("compare.map_") if laid.by == "compare" else None
    return WIPE if desk.wiped else ""


def _pixel(session, desk, say):
    """The picked pixel in both pictures."""
    c, mine = session.cursor, session.record.value
    if desk.twin is not None:
        its = desk.twin.record.value
    elif desk.picture is not None and desk.verdict is not None:
        its = desk.picture.rgb[c.y, c.x]
    else:
        return []
    rows = {"a": mine, "b": its, "a_less_b": mine - its}
    return [
        {"key": key, "name": say(f"compare.{key}"), "value": several(value),
         "exact": [number(v) for v in value]}
        for key, value in rows.items()
    ]  # fmt: skip


def _verdict(desk, say):
    verdict, distance, z = desk.verdict, desk.verdict.errors, desk.verdict.z
    rows = {
        "rmse": short(distance.rmse),
        "rel_mse": short(distance.rel_mse),
        "mean": several(distance.mean),
        "most": f"{short(distance.most)}  ({distance.worst[0]}, {distance.worst[1]})",
    }
    if z is not None:
        rows |= {"Z": several(z.Z), "p_value": short(z.p_value)}
    return {
        "equal": distance.equal,
        "said": say(_said(verdict)),
        "rows": [{"name": say(f"compare.{key}"), "value": value} for key, value in rows.items()],
        "exact": diff.as_dict(verdict, ("a", "b")),
        "worst": list(desk.first),
        "notes": [say.error(note) for note in verdict.notes],
    }


def _said(verdict):
    """The key of what is said of two pictures."""
    if verdict.errors.equal:
        return "compare.equal"
    if verdict.z is None:
        return "compare.differ"
    return "compare.noise" if verdict.same else "compare.more_than_noise"


def _twin(there, desk, say):
    """Where the selected path and its twin part."""
    said = {"parts": False, "step": None, "numbers": []}
    if there is None:
        return said | {"said": say("compare.path_alone")}
    parting = there.parting
    if parting is None:
        return said | {"said": say("compare.together")}
    step = next(s for s in parting.steps if s is not None)
    numbers = [_number(n, parting.kinds[0], desk, say) for n in parting.numbers]
    words = say(
        "compare.parts", step=step, event=event_of(parting.kinds, say), what=what_differs(parting.what, say)
    )
    return {"parts": True, "step": step, "said": words, "numbers": numbers}


def _number(differing, kind, desk, say):
    """A field that differs, with both values."""
    name = differing.field.name
    a, b = told_apart(differing, desk.twin.scenes, say)
    meaning = say.optional(f"field.{kind}.{name}", differing.field.meaning)
    return {"name": name, "meaning": meaning, "a": a, "b": b}


def _paths(session, desk, say):
    """The pixel's paths that part, those that differ most first."""
    found = desk.twin.found
    rows = [
        {
            "path": say("find.path", path=p.sample),
            "event": event_of(p.kinds, say),
            "what": what_differs(p.what, say),
            "now": p.sample == session.path.sample,
        }
        for p in found.largest
    ]
    key = "compare.differing" if found.differing else "compare.none_differing"
    words = say(key, n=found.pairs, **({"differing": found.differing} if found.differing else {}))
    return {"differing": found.differing, "said": words, "rows": rows}


def _whole(session, desk, say):
    """In which ways paths from all over the picture part, the most frequent first."""
    few, pixels = planned(session.settings, MOST_PATHS)
    found, said = desk.whole, say("compare.would", n=few.spp * pixels.size)
    if desk.searching:
        said = say("compare.searching")
    elif found is not None:
        said = say("compare.parted", differing=found.differing, n=found.pairs)
    causes = [
        {
            "pairs": c.pairs,
            "key": c.what,
            "event": say("compare.cause", event=event_of(c.kinds, say), depth=range_of(c.depths, say)),
            "what": all_that_differs(c, say),
        }
        for c in (found.causes if found else ())
    ]
    return {"busy": desk.searching, "said": said, "causes": causes}


PANEL = Panel("compare", "tab", "path", 45, TEMPLATE, show, calls)
