"""The figures of ACCURACY.md, one module a family.

A family has TITLE, figures() and, if there is more to say than its table, notes(): text to stand below it.
A new one goes into FAMILIES.
"""

from figures import abandoned, continuation, escapes, exact, invalid, pictures, reproduced, sampling

FAMILIES = (exact, sampling, pictures, escapes, continuation, invalid, reproduced, abandoned)


def figures():
    """Every figure that is measured, family by family."""
    for family in FAMILIES:
        yield from family.figures()
