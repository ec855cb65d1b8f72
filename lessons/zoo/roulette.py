"""How paths end."""

import numpy as np

from lessons.zoo.bug import Bug

FAIR = "I9: a share q of the paths goes on, and each of those carries exactly one 1/q"


def without_division(beta, probability, u):
    """The survivors do not stand in for the dead."""
    return u < probability, beta


def reversed_test(beta, probability, u):
    """Who should die goes on."""
    return u > probability, beta / probability


def one_fifth(settings, beta, depth):
    """Four of five paths die at every bounce: right on average, and useless."""
    return np.full_like(beta[0], 0.2)


def depth_cut(settings, beta, depth):
    """Every path ends after its second bounce, and nothing makes up for it."""
    return np.where(depth < 1, 1.0, 0.0).astype(beta.dtype)


BUGS = (
    Bug(
        "R01",
        "Roulette without division",
        "Indirect light is too dark, the more the longer the path.",
        "if xi < q: go on; without beta /= q",
        FAIR,
        {"roulette": without_division},
    ),
    Bug(
        "R03",
        "Roulette test reversed",
        "Long paths are missing: a share 1 - q goes on instead of q.",
        "if xi > q: go on",
        FAIR,
        {"roulette": reversed_test},
    ),
    Bug(
        "R05",
        "Hard depth cut instead of roulette",
        "Too dark in corners and on the ceiling, where light arrives after many bounces.",
        "if depth > limit: return 0",
        "I9: there is no way to end that is not paid for by the survivors",
        {"survival": depth_cut},
    ),
    Bug(
        "R06",
        "Survival probability far too small",
        "Black pixels and coloured confetti: right on average, with a hundred times the variance.",
        "q = 0.2, to find the mistake faster",
        "I19: error at equal cost",
        {"survival": one_fifth},
    ),
)
