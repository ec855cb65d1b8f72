"""Formulas as MathML, in which a factor may name the event that a click on it leads to."""

import re
from functools import lru_cache


@lru_cache(512)
def mathml(latex):
    """LaTeX as MathML; the converter is loaded when the first formula is."""
    from latex2mathml.converter import convert

    plus, equals = "<mo>&#x0002B;</mo>", "<mo>&#x0003D;</mo>"
    return convert(latex, display="block").replace(plus + equals, "<mo>+=</mo>")


def fraction(target, sides, between, result=""):
    """target, product over product, result. sides: above and below the line, (LaTeX, event or None) of each
    factor; with nothing below there is no line. between: LaTeX between two factors."""
    over, under = (_product(factors, between) for factors in sides)
    body = f"<mfrac>{over}{under}</mfrac>" if sides[1] else over
    return f'<math display="block"><mrow>{_inside(target)}{body}{_inside(result)}</mrow></math>'


def _product(factors, between):
    return f"<mrow>{_inside(between).join(_led(_inside(latex), event) for latex, event in factors)}</mrow>"


def _led(inside, event):
    return inside if event is None else f'<mrow class="from" data-step="{event}">{inside}</mrow>'


@lru_cache(512)
def _inside(latex):
    """What stands within the MathML of some LaTeX."""
    found = re.search(r"<math[^>]*>(.*)</math>", mathml(latex), re.DOTALL) if latex else None
    return found.group(1) if found else ""
