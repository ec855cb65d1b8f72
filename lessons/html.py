"""Lesson texts as HTML with formulas in MathML; links to moments lead where the caller says."""

import re
from functools import cache
from html import escape

from lessons.words import markdown


def html(text, href):
    """A text, its numbers filled in already, as HTML. href(moment id): the address of a link to a moment."""
    made = _renderer().render(text)
    return re.sub(r'href="#([\w-]+)"', lambda found: f'href="{escape(href(found[1]))}"', made)


@cache
def mathml(latex, display=False):
    """One formula. The converter is loaded when the first is."""
    from latex2mathml.converter import convert

    return convert(latex.strip(), display="block" if display else "inline")


@cache
def _renderer():
    reader = markdown()
    reader.add_render_rule("math_inline", lambda self, tokens, k, *_: mathml(tokens[k].content))
    for name in ("math_block", "math_block_label"):
        reader.add_render_rule(name, _displayed)
    return reader


def _displayed(self, tokens, k, options, env):
    label = f' id="formula-{escape(tokens[k].info)}"' if tokens[k].info else ""
    return f'<div class="formula"{label}>{mathml(tokens[k].content, True)}</div>\n'
