"""Lesson texts as HTML with formulas in MathML; links to moments lead where the caller says."""

import re
from functools import cache
from html import escape

from lessons.plain import NAMES
from lessons.words import TaskWords, markdown

# What the converter does otherwise than a formula is set: no room around sin and its like, bars that stretch
# where nobody asked for it, an arrow that is taken for a name.
BAR = '<mo stretchy="false" lspace="0" rspace="0">'
MENDED = {f"<mo>&#x{bar};</mo>": f"{BAR}&#x{bar};</mo>" for bar in ("02016", "0007C")}
MENDED |= {"<mi>&#x027FA;</mi>": "<mo>&#x027FA;</mo>"}
NAME = rf"\\(?:{'|'.join(NAMES)})(?![A-Za-z])"
SCRIPT = r"[\^_](?:\{[^{}]*\}|\\[A-Za-z]+|.)"
BEFORE = re.compile(rf"(?<=[\w}}])\s*({NAME})")
OPTION = re.compile(r"(?<!\S)--[a-z][\w-]*")
AFTER = re.compile(rf"({NAME}(?:{SCRIPT})*)\s*(?=[A-Za-z\\])(?!\\(?:left|[,;:! ]))")


def html(text, href):
    """A text, its numbers filled in already, as HTML. href(moment id): the address of a link to a moment."""
    made = _renderer().render(text)
    return re.sub(r'href="#([\w-]+)"', lambda found: f'href="{escape(href(found[1]))}"', made)


def body(run, language, href):
    """A lesson's text as pages show it: pieces of HTML, and TaskWords whose words are HTML."""

    def made(text):
        return html(run.fill(text), href)

    for part in run.lesson.words[language].body:
        if isinstance(part, str):
            yield made(part)
            continue
        choices = {name: made(text) for name, text in part.choices.items()}
        wrong = {k: made(text) for k, text in part.wrong.items()}
        hints = [made(text) for text in part.hints]
        yield TaskWords(part.id, made(part.ask), choices, hints, wrong, made(part.solution))


@cache
def mathml(latex, display=False):
    """One formula. The converter is loaded when the first is."""
    from latex2mathml.converter import convert

    spaced = BEFORE.sub(r"\,\1", AFTER.sub(r"\1\,", latex.strip()))
    made = convert(spaced, display="block" if display else "inline")
    for said, meant in MENDED.items():
        made = made.replace(said, meant)
    return made


@cache
def _renderer():
    reader = markdown()
    reader.add_render_rule("math_inline", lambda self, tokens, k, *_: mathml(tokens[k].content))
    reader.add_render_rule("code_inline", lambda self, tokens, k, *_: _code(tokens[k].content))
    for name in ("math_block", "math_block_label"):
        reader.add_render_rule(name, _displayed)
    return reader


def _code(text):
    """Code within a line; an option stays whole, which browsers would break after its dashes."""
    whole = OPTION.sub(r'<span class="option">\g<0></span>', escape(text, quote=False))
    return f"<code>{whole}</code>"


def _displayed(self, tokens, k, options, env):
    label = f' id="formula-{escape(tokens[k].info)}"' if tokens[k].info else ""
    return f'<div class="formula"{label}>{mathml(tokens[k].content, True)}</div>\n'
