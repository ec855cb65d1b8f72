"""The race of castray and Mitsuba 3: children that render on request, a common truth, and ratios."""

from benchmarks.section import Section

RACE = Section(
    "race",
    "Side by side with Mitsuba 3",
    "`make race`: both programs render cornell_unit from the same file by turns, each in a process that\n"
    "stays up, warm: pool up, kernels compiled, scene loaded. The error is against the mean of long renders\n"
    "of both. Ratios are castray's figure over Mitsuba's, seed by seed: geometric mean and 95 % interval\n"
    "(Student's t on logarithms). Each program's best sampler at that number of samples counts.",
    None,
)
