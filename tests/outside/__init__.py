"""Mistakes that are in no catalogue: what the doctor was not written for.

Each says which laws a reader would call the broken ones, and which names of the catalogue would be fair,
mostly none. `steps` are replaced steps of castray's own loop, `cpp` and `python` changed lines of programs
that log, or are watched.
"""

from outside import balls, corridor, cpp, more_python, more_steps, python, shed, steps, two_rays

_FAMILIES = (steps, cpp, python, more_steps, balls, more_python, two_rays, corridor, shed)
MISTAKES = {mistake.id: mistake for family in _FAMILIES for mistake in family.MISTAKES}
