"""Builds the site: a page for each lesson and language, an index, and what the program says of itself."""

import os
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from itertools import chain
from multiprocessing import get_context

from lessons.course import lesson, lessons
from tracer.settings import TracerError
from viewer.site import formula_map, index, lesson_page, log_format, reference
from viewer.words import LANGUAGES, Speaker


def build(folder, numbers=None, solutions=True, workers=None, progress=None):
    """Write the site into a folder; the names of its files. Raises TracerError.

    numbers: of the lessons that get a page, all without; progress(done, total) is called after each of them.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise TracerError(f"{folder}: cannot be written: {error.strerror or error}") from None
    numbers = list(lessons()) if numbers is None else numbers
    workers = min(workers or os.cpu_count() or 1, len(numbers))
    names = []
    for done, pages in enumerate(chain([_around()], _each(numbers, solutions, workers))):
        for name, text in pages.items():
            _write(folder / name, text)
            names.append(name)
        if progress:
            progress(done, len(numbers))
    return names


def _each(numbers, solutions, workers):
    """The pages of each lesson, by name."""
    make = partial(lesson_pages, solutions=solutions)
    if workers == 1:
        yield from map(make, numbers)
        return
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        yield from pool.map(make, numbers)


def lesson_pages(number, solutions=True):
    """{name: text} of the pages of one lesson, one for each language."""
    return lesson_page.pages(lesson(number), solutions)


def _around():
    """{name: text} of the pages that are no lesson."""
    made = {"reference.html": reference.page()}
    for language in LANGUAGES:
        say = Speaker(language)
        made |= {
            index.file_of(language): index.page(say),
            formula_map.file_of(language): formula_map.page(say),
            log_format.file_of(language): log_format.page(say),
        }
    return made


def _write(path, text):
    try:
        path.write_text(text, encoding="utf-8", newline="\n")
    except OSError as error:
        raise TracerError(f"{path}: cannot be written: {error.strerror or error}") from None
