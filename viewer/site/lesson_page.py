"""A lesson as a page: its text, and beside it the places it speaks of, pictures and paths in 3D."""

import re
import shlex
from html import escape

import tracer
from lessons.course import lessons
from lessons.html import body
from lessons.run import Run
from lessons.words import TaskWords
from lessons.zoo import planted
from viewer.lesson_report import WAYS
from viewer.link import of_moment
from viewer.offline import View, furniture
from viewer.site.frame import HERE, framed, named
from viewer.words import LANGUAGES, Speaker

LABELLED = re.compile(r'<div class="formula" id="formula-([\w-]+)">')
MOST_SAMPLES = 8  # of a pixel of the pictures


def pages(it, solutions):
    """{name: text} of a lesson's pages. solutions: whether they say how its tasks are solved."""
    run = Run(it)
    pictures = {}
    for name in it.moments:
        key = (run.scene_of(name), run.settings(name))
        if key not in pictures:
            pictures[key] = _picture(run, name)
    shown = {name: pictures[run.scene_of(name), run.settings(name)] for name in it.moments}
    return {file_of(it, tag): _page(run, Speaker(tag), shown, solutions) for tag in LANGUAGES}


def file_of(it, language):
    """The file of a lesson."""
    return named(_stem(it), language)


def _stem(it):
    return f"lesson-{it.number:02}"


def _picture(run, moment):
    settings = run.settings(moment)
    if settings.replicates == 1:
        settings = settings.at_spp(min(settings.spp, MOST_SAMPLES))
    return tracer.render(run.scene_of(moment), settings, steps=planted(settings)).rgb


def _page(run, say, pictures, solutions):
    it = run.lesson
    title = say("lesson.head", number=it.number, title=it.words[say.language].title)
    text = "\n".join(
        part if isinstance(part, str) else _task(it, part, say, solutions)
        for part in body(run, say.language, lambda moment: f"#place-{moment}")
    )
    text = LABELLED.sub(lambda found: found[0] + _code(it, found[1], say), text)
    view, commands = View(say), {}
    for moment, at in it.moments.items():
        path = run.path(moment)
        view.add(moment, run.scene_of(moment), (at.x, at.y), [path], 0, at.event, pictures[moment])
        commands[moment] = f"castray view {shlex.quote('#' + of_moment(at).write())}"
    main = (
        f'<article><h1>{escape(title)}</h1><p class="dim">{escape(_about(it, say))}</p>\n{text}\n{_foot(it, say)}</article>'
        f'<aside><div class="castray-3d"></div><p class="dim">{escape(say("site.open"))}<br>'
        f'<code id="command"></code></p></aside>'
        f'<script type="application/json" id="paths">{view.script(list(it.moments).index("start"))}</script>'
        f'<template id="commands">{"".join(f"<i id={k}>{escape(c)}</i>" for k, c in commands.items())}</template>'
    )
    styles, scripts = furniture()
    own = (HERE / "lesson.js").read_text(encoding="utf-8")
    return framed(title, main, _stem(it), say.language, styles, f"{scripts}\n{own}", wide=True)


def _code(it, label, say):
    """The link from a formula to what computes it."""
    href = f"{named('formulas', say.language)}#{it.number:02}-{label}"
    return f'<a class="code" href="{href}" title="{escape(it.formulas[label].function)}">{escape(say("site.code"))}</a>'


def _about(it, say):
    return say("site.about", n=it.minutes, tasks=len(it.tasks))


def _task(it, words: TaskWords, say, solutions):
    task = it.tasks[words.id]
    choices = "".join(f"<li><b>{name})</b> <span>{text}</span></li>" for name, text in words.choices.items())
    unit = f" ({task.unit})" if task.unit else ""
    way = f"castray lesson {it.number} --check {words.id} {WAYS[task.kind]}{unit}"
    folded = [(say("lesson.hint", k=k, n=len(words.hints)), text) for k, text in enumerate(words.hints, 1)]
    if solutions:
        folded.append((say("lesson.solution"), words.solution))
    aids = "".join(
        f"<details><summary>{escape(head)}</summary><div>{text}</div></details>" for head, text in folded
    )
    return (
        f'<section class="task" id="task-{words.id}"><h3>{escape(say("lesson.task", id=words.id))}</h3>{words.ask}'
        f"{f'<ul class=choices>{choices}</ul>' if choices else ''}"
        f'<p class="dim">{escape(say("lesson.answer", command=""))}<code>{escape(way)}</code></p>{aids}</section>'
    )


def _foot(it, say):
    lines = []
    if it.bugs:
        lines.append(say("lesson.mistake", bugs=say.listed(*it.bugs), bug=it.bugs[0]))
    if it.references:
        lines.append(say("lesson.references", works="; ".join(it.references)))
    around = []
    for key, step in (("before", -1), ("next", 1)):
        other = lessons().get(_neighbour(it.number, step))
        if other:
            head = say("lesson.head", number=other.number, title=other.words[say.language].title)
            label = say("lesson.next" if step > 0 else "site.before", title=head)
            around.append(f'<a rel="{key}" href="{file_of(other, say.language)}">{escape(label)}</a>')
    said = "".join(f'<p class="dim">{escape(line)}</p>' for line in lines)
    return f'<footer>{said}<p class="around">{" ".join(around)}</p></footer>'


def _neighbour(number, step):
    numbers = list(lessons())
    place = numbers.index(number) + step
    return numbers[place] if 0 <= place < len(numbers) else None
