"""The doctor: which laws the picture's paths break, the first cause first, and the event that proves it."""

from lessons.course import lesson
from viewer import examining, picture_examining
from viewer.doctor_report import bug_title, bugs, chance, counted, equation, following, place, wrong_code
from viewer.examining import Chart, Examiner
from viewer.panels.panel import Panel
from viewer.picture_examining import Guesser
from viewer.worker import Worker

TEMPLATE = """
<div class="doctor" data-testid="doctor">
  <div class="between"><p class="status dim" role="status" data-testid="doctor-status"><span v-if="doctor.busy" class="busy" aria-hidden="true"></span>{{ doctor.status }}</p>
    <button data-testid="doctor-examine" :disabled="doctor.busy" @click="trigger('doctor_examine')">{{ w.exam_examine }}</button></div>
  <p v-if="doctor.error" class="warning" role="alert" data-testid="doctor-error">{{ doctor.error }}</p>
  <p v-if="doctor.verdict" :class="doctor.good ? 'good' : 'warning'" data-testid="doctor-verdict">{{ doctor.verdict }}</p>
  <ol v-if="doctor.causes.length" class="findings" :aria-label="w.exam_findings"><li v-for="f in doctor.causes" :key="f.rule" class="finding" :class="{now: f.now}"
    :data-testid="'finding-' + f.index" :data-rule="f.rule" :data-bug="f.bug" :data-count="f.count" :data-checked="f.checked">
    <button class="plain head" :data-testid="'finding-go-' + f.index" :aria-current="f.now ? 'true' : null" :disabled="!f.place" :title="f.place ? w.exam_go : null" @click="trigger('doctor_go', [f.index])">
      <b v-if="f.bug" class="bug">{{ f.bug }}</b> <b>{{ f.name }}</b></button>
    <p>{{ f.law }}</p><p v-if="f.formula"><code>{{ f.formula }}</code></p>
    <table v-if="f.right" class="beside"><tbody><tr><th scope="row">{{ w.exam_recorded }}</th><td class="number bad" :data-testid="'finding-recorded-' + f.index" :data-exact="JSON.stringify(f.exact.recorded)">{{ f.recorded }}</td></tr>
      <tr><th scope="row">{{ w.exam_right }}</th><td class="number ok" :data-testid="'finding-right-' + f.index" :data-exact="JSON.stringify(f.exact.right)">{{ f.right }}</td></tr></tbody></table>
    <p v-if="f.why">{{ f.why }}</p><p v-for="c in f.code" :key="c">{{ c }}</p><p v-if="f.chance" class="dim">{{ f.chance }}</p>
    <p class="links"><button v-if="f.place" :data-testid="'finding-event-' + f.index" @click="trigger('doctor_go', [f.index])">{{ f.place }}</button>
      <button :data-testid="'finding-where-' + f.index" @click="trigger('doctor_where', [f.index])">{{ w.exam_where }}</button>
      <button v-if="f.lesson" :data-testid="'finding-lesson-' + f.index" @click="tab = 'lesson'; trigger('lesson_open', [f.lesson.number, true])">{{ f.lesson.title }}</button></p></li></ol>
  <details v-if="doctor.following.length"><summary>{{ doctor.following_head }}</summary><ul class="rules"><li v-for="f in doctor.following" :key="f.rule">
    <button class="plain" :disabled="!f.place" @click="trigger('doctor_go', [f.index])">{{ f.text }}</button></li></ul></details>
  <details v-if="doctor.clean.length" data-testid="doctor-clean" :data-rules="doctor.clean.length"><summary>{{ doctor.clean_head }}</summary>
    <table class="rows"><thead><tr><th scope="col">{{ w.exam_rule }}</th><th scope="col" class="number">{{ w.exam_checked }}</th></tr></thead><tbody>
      <tr v-for="r in doctor.clean" :key="r.rule" :title="r.law"><td>{{ r.title }}</td><td class="number">{{ r.checked }}</td></tr></tbody></table></details>
  <details v-if="doctor.untestable.length" data-testid="doctor-untestable" :data-rules="doctor.untestable.length"><summary>{{ doctor.untestable_head }}</summary>
    <table class="rows"><thead><tr><th scope="col">{{ w.exam_rule }}</th><th scope="col">{{ w.exam_missing }}</th></tr></thead><tbody>
      <tr v-for="r in doctor.untestable" :key="r.rule" :title="r.law"><td>{{ r.title }}</td><td class="dim">{{ r.missing }}</td></tr></tbody></table></details>
  <section v-if="doctor.picture" class="finding asked" data-testid="doctor-picture"><div class="between"><p>{{ doctor.picture.head }}</p>
    <button data-testid="doctor-guess" :disabled="doctor.picture.busy" @click="trigger('doctor_guess')"><span v-if="doctor.picture.busy" class="busy" aria-hidden="true"></span>{{ w.exam_guess }}</button></div>
    <p v-if="doctor.picture.status" class="dim" data-testid="doctor-guessing">{{ doctor.picture.status }}</p>
    <p v-if="doctor.picture.error" class="warning" role="alert">{{ doctor.picture.error }}</p>
    <p v-if="doctor.picture.verdict" :class="doctor.picture.good ? 'good' : 'warning'" data-testid="doctor-guessed">{{ doctor.picture.verdict }}</p>
    <ul v-if="doctor.picture.hypotheses.length" class="findings"><li v-for="(h, k) in doctor.picture.hypotheses" :key="k" :data-testid="'hypothesis-' + k"><b>{{ h[0] }}</b><p v-for="line in h.slice(1)" :key="line">{{ line }}</p></li></ul></section>
</div>
"""


def calls(window):
    """What this panel's page may ask for."""
    examiner, guesser = Examiner(window, Worker(window.back)), Guesser(window, Worker(window.back))
    return {
        "doctor_examine": examiner.examine,
        "doctor_go": examiner.go,
        "doctor_where": examiner.where,
        "doctor_guess": guesser.guess,
    }


def show(session, say):
    """What the doctor said, if it was asked."""
    chart = session.desk.get("doctor") or Chart()
    diagnosis = chart.diagnosis
    shown = {"busy": chart.busy, "status": _status(session, chart, say), "verdict": "", "good": False}
    shown["error"] = say.error(str(chart.error)) if chart.error else ""
    shown["picture"] = picture_examining.shown(session, say)
    findings = list(enumerate(diagnosis.findings)) if diagnosis else []
    shown["causes"] = [_cause(k, f, chart, say) for k, f in findings if f.follows is None]
    shown["following"] = [
        _following(k, f, diagnosis.findings, say) for k, f in findings if f.follows is not None
    ]
    rules = diagnosis.rules if diagnosis else ()
    shown["clean"] = [_rule(v, say) for v in rules if v.state == "clean"]
    shown["untestable"] = [_rule(v, say) for v in rules if v.state == "not_testable"]
    for name in ("following", "clean", "untestable"):
        shown[f"{name}_head"] = say(f"exam.{name}", n=len(shown[name]))
    if diagnosis:
        shown["good"] = not findings and bool(shown["clean"])
        said = "exam.found" if findings else "doctor.nothing" if shown["good"] else "doctor.unjudged"
        shown["verdict"] = say(said, n=len(shown["causes"]))
    return shown


def _status(session, chart, say):
    if chart.busy:
        return say("exam.busy")
    if chart.diagnosis:
        return say("exam.done", paths=chart.paths)
    if session.recording:
        return say("exam.recording")
    settings = session.settings
    return say("exam.would", paths=examining.number_of_paths(settings), seconds=examining.seconds(settings))


def _cause(index, finding, chart, say):
    """A finding with a cause of its own, in full."""
    first = finding.first
    said = counted(finding, say)
    both = finding.recorded is not None and finding.right is not None
    return {
        "index": index,
        "now": index == chart.now,
        "rule": finding.rule,
        "bug": bugs(finding, say),
        "name": bug_title(finding.bug, say) if finding.bug else said["title"],
        "law": say("doctor.not_so", **said),
        "count": finding.count,
        "checked": finding.checked,
        "formula": say.formula(finding.rule, finding.formula),
        "recorded": equation(say.quantity(finding.what), finding.recorded, say) if both else "",
        "right": equation(say.quantity(finding.what), finding.right, say) if both else "",
        "exact": {"recorded": finding.recorded, "right": finding.right},
        "why": say.clue(finding.explanation),
        "code": [say("doctor.code_of", bug=bug, code=code) for bug, code in wrong_code(finding, say)],
        "chance": "" if finding.p is None else chance(finding, say),
        "place": place(first, say) if first else "",
        "lesson": None if finding.lesson is None else _lesson(finding.lesson, say),
    }


def _lesson(number, say):
    title = lesson(number).words[say.language].title
    return {"number": number, "title": say("lesson.head", number=number, title=title)}


def _following(index, finding, findings, say):
    text = following(finding, findings, say)
    return {"index": index, "rule": finding.rule, "text": text, "place": bool(finding.first)}


def _rule(verdict, say):
    rule = verdict.rule
    return {
        "rule": rule.id,
        "title": say.optional(f"rule.{rule.id}", rule.title),
        "law": say.optional(f"law.{rule.id}", rule.law),
        "checked": f"{verdict.checked:,}",
        "missing": say.lacking(verdict.missing),
    }


PANEL = Panel("doctor", "tab", "picture", 50, TEMPLATE, show, calls)
