"""The course beside the scene: the lessons with what is solved, or the text of one with its tasks."""

from functools import cache

from lessons import zoo
from lessons.answer import Verdict
from lessons.course import lessons
from viewer.panels.panel import Panel
from viewer.reading import PLACES, Reader, address, course_of
from viewer.worker import Worker

TEMPLATE = """
<div class="lesson" data-testid="lesson" :data-number="lesson.number">
  <p v-if="lesson.unkept" class="warning" data-testid="lesson-unkept">{{ w.lesson_unkept }}</p>
  <template v-if="lesson.number === null"><p>{{ w.lesson_intro }}</p>
    <ol class="course" :aria-label="w.lesson_list"><li v-for="l in lesson.rows" :key="l.number"><a :href="l.start" :data-testid="'lesson-' + l.number" @click="trigger('lesson_open', [l.number, true])">
      <span class="number dim">{{ l.label }}</span><span class="grow">{{ l.title }}</span><span class="dim">{{ l.time }}</span>
      <span class="ticks" :class="{good: l.done}" role="img" :title="l.solved" :aria-label="l.solved">{{ l.ticks }}</span></a></li></ol></template>
  <castray-reading v-else :key="lesson.number" :number="lesson.number" :link="link">
    <div class="between"><button data-testid="lesson-list" @click="trigger('lesson_close')">{{ w.lesson_list }}</button>
      <span class="dim" data-testid="lesson-about">{{ lesson.about }}</span></div>
    <h2 class="title" data-testid="lesson-title">{{ lesson.title }}</h2>
    <p v-if="lesson.busy" class="dim" role="status"><span class="busy" aria-hidden="true"></span>{{ w.lesson_busy }}</p>
    <p v-if="lesson.error" class="warning" role="alert" data-testid="lesson-error">{{ lesson.error }}</p>
    <template v-for="(part, k) in lesson.parts" :key="k"><div v-if="part.html" class="prose" v-html="part.html"></div>
      <section v-else class="task" :class="{solved: part.solved}" :aria-label="part.head" :data-testid="'task-' + part.id" :data-solved="part.solved">
        <h3><span v-if="part.solved" class="good" aria-hidden="true">✓ </span>{{ part.head }}</h3><div class="prose" v-html="part.ask"></div>
        <castray-answer :task="part" :words="w" :bugs="lesson.bugs" @answer="trigger('lesson_answer', [part.id, $event])"
          :place="part.kind === 'pixel' ? '(' + picture.x + ', ' + picture.y + ')' : part.kind === 'path' ? path_index : event_index"></castray-answer>
        <div v-if="part.reply" class="reply" :class="part.right ? 'good' : 'bad'" role="status" :data-testid="'reply-' + part.id" :data-right="part.right"><b>{{ part.reply }}</b><div v-if="part.said" class="prose" v-html="part.said"></div></div>
        <div v-for="hint in part.hints" :key="hint.head" class="aid" :data-testid="'hints-' + part.id"><h4>{{ hint.head }}</h4><div class="prose" v-html="hint.html"></div></div>
        <div v-if="part.solution" class="aid" :data-testid="'solution-' + part.id"><h4>{{ w.lesson_solution }}</h4><div class="prose" v-html="part.solution"></div></div>
        <div class="row"><button v-if="part.more" :data-testid="'hint-' + part.id" @click="trigger('lesson_hint', [part.id])">{{ w.lesson_hint }}</button>
          <button v-if="part.tried" :data-testid="'show-' + part.id" @click="trigger('lesson_solution', [part.id])">{{ w.lesson_show }}</button></div>
      </section></template>
    <p v-for="line in lesson.foot" :key="line" class="dim">{{ line }}</p>
    <a v-if="lesson.next" :href="lesson.next.start" data-testid="lesson-next" @click="trigger('lesson_open', [lesson.next.number, true])">{{ lesson.next.title }}</a>
  </castray-reading>
</div>
"""


def calls(window):
    """What this panel's page may ask for."""
    reader = Reader(window, Worker(window.back))
    return {
        "lesson_open": reader.open,
        "lesson_close": reader.close,
        "lesson_answer": reader.answer,
        "lesson_hint": reader.hint,
        "lesson_solution": reader.solution,
    }


def show(session, say):
    """The list, or the open lesson."""
    course = course_of(session)
    shown = {"unkept": not course.progress.kept, "number": None, "rows": [], "parts": []}
    if course.open is None:
        return shown | {"rows": [_row(it, course.progress, say) for it in lessons().values()]}
    return shown | _open(course.open, course.progress, say)


@cache
def _start(number):
    """Where a lesson begins; kept, since whatever is turned in the scene has the whole list told again."""
    return address(lessons()[number].moments["start"])


def _row(it, progress, say):
    solved = progress.solved(it.number)
    return {
        "number": it.number,
        "start": _start(it.number),
        "label": f"{it.number:02}",
        "title": it.words[say.language].title,
        "time": say("lesson.minutes", n=it.minutes),
        "ticks": "".join("✓" if task in solved else "·" for task in it.tasks),
        "solved": say("lesson.solved", n=len(solved & it.tasks.keys()), tasks=len(it.tasks)),
        "done": solved >= it.tasks.keys(),
    }


def _open(reading, progress, say):
    it, text = reading.run.lesson, reading.texts.get(say.language, ())
    solved = progress.solved(it.number) & it.tasks.keys()
    foot = [say("lesson.all_solved")] if len(solved) == len(it.tasks) else []
    if it.bugs:
        foot.append(say("lesson.mistake", bugs=say.listed(*it.bugs), bug=it.bugs[0]))
    if it.references:
        foot.append(say("lesson.references", works="; ".join(it.references)))
    return {
        "number": it.number,
        "title": say("lesson.head", number=it.number, title=it.words[say.language].title),
        "about": say("lesson.about", n=it.minutes, solved=len(solved), tasks=len(it.tasks)),
        "busy": not text and reading.error is None,
        "error": say.error(str(reading.error)) if reading.error else "",
        "parts": [{"html": p} if isinstance(p, str) else _task(reading, p, progress, say) for p in text],
        "bugs": _bugs(say) if any(task.kind == "bug" for task in it.tasks.values()) else [],
        "foot": foot if text else [],
        "next": _next(it.number, say) if text else None,
    }


def _task(reading, words, progress, say):
    it = reading.run.lesson
    task, done = it.tasks[words.id], progress.of(it.number, words.id)
    hints = [
        {"head": say("lesson.hint", k=k, n=len(words.hints)), "html": html}
        for k, html in enumerate(words.hints[: done.hints], 1)
    ]
    shown = task.id in reading.shown
    return {
        "id": task.id,
        "kind": task.kind,
        "unit": task.unit,
        "head": say("lesson.done" if done.solved else "lesson.task", id=task.id),
        "ask": words.ask,
        "choices": [{"id": name, "html": html} for name, html in words.choices.items()],
        "place": task.kind in PLACES,
        "there": address(it.moments[task.at]) if task.kind in PLACES else "",
        "busy": reading.judging == task.id,
        "solved": done.solved,
        "hints": hints,
        "more": done.hints < len(words.hints) and not done.solved and not shown,
        "tried": done.tries > 0 and not shown,
        "solution": words.solution if shown else "",
    } | _reply(reading.replies.get(task.id), words, say)


def _reply(reply, words, say):
    if reply is None:
        return {"reply": "", "said": "", "right": False}
    if not isinstance(reply, Verdict):
        return {"reply": say.error(str(reply)), "said": "", "right": False}
    said = "" if reply.right else words.wrong.get(reply.known, "")
    return {
        "reply": say("lesson.right" if reply.right else "lesson.wrong"),
        "said": said,
        "right": reply.right,
    }


def _bugs(say):
    """The zoo by family, to choose from."""
    return [
        {
            "family": say.optional(f"family.{family}", family),
            "bugs": [{"id": b.id, "title": say.optional(f"bug.{b.id}", b.title)} for b in bugs],
        }
        for family, bugs in zoo.FAMILIES.items()
    ]


def _next(number, say):
    later = next((it for it in lessons().values() if it.number > number), None)
    if later is None:
        return None
    head = say("lesson.head", number=later.number, title=later.words[say.language].title)
    start = address(later.moments["start"])
    return {"number": later.number, "start": start, "title": say("lesson.next", title=head)}


PANEL = Panel("lesson", "tab", "picture", 80, TEMPLATE, show, calls)
