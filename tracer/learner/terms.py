"""The terms that a learner's colour is the sum of, and the factors (leaves) in them."""

from collections import defaultdict

import numpy as np

from tracer.learner.value import dot

SURE = 1e-6  # how far vectors may be apart that are meant to be one


class Terms:
    """The terms of what a call returned, by what they carry."""

    def __init__(self, call):
        self._emission, self._light, self._child = [], defaultdict(list), defaultdict(list)
        for factor, powers in call.returned.terms:
            kinds = {leaf.kind: leaf for leaf, power in powers if power > 0}
            if "child" in kinds:
                self._child[id(kinds["child"].of["call"])].append((factor, powers))
            elif "Le" in kinds and "light" in kinds["Le"].of:
                self._light[id(kinds["Le"].of["light"])].append((factor, powers))
            else:
                self._emission.append((factor, powers))

    def emission(self):
        """What comes from the surface itself, or from nowhere known, (3,)."""
        return sum((_worth(*term) for term in self._emission), np.zeros(3))

    def of_light(self, sample):
        """Leaves of a light sample's terms, and what they bring, (3,)."""
        terms = self._light[id(sample)]
        leaves = [leaf for _, powers in terms for leaf, _ in powers]
        return leaves, sum((_worth(*term) for term in terms), np.zeros(3))

    def of_child(self, child):
        """Leaves of an inner call's terms."""
        return [leaf for _, powers in self._child[id(child)] for leaf, _ in powers if leaf.kind != "child"]

    def factor(self, child):
        """What an inner call's colour was multiplied with, (3,)."""
        terms = self._child[id(child)]
        return sum((_worth(factor, powers, but="child") for factor, powers in terms), np.zeros(3))


def _worth(factor, powers, but=""):
    """A term's value (3,), without leaves of the kind `but`."""
    found = np.ones(3) * factor
    with np.errstate(all="ignore"):
        for leaf, power in powers:
            if leaf.kind != but:
                found = found * np.asarray(leaf.value, np.float64) ** power
    return found


def only(leaves, kind):
    """The one leaf of a kind, None where there is none or there are several."""
    found = {id(leaf): leaf for leaf in leaves if leaf.kind == kind}
    return next(iter(found.values())) if len(found) == 1 else None


def cosine(leaves, n):
    """The one dot product with the vertex's normal, None where there is none. Of one with the opposite of
    it, such as the normal of a lamp above, only the size counts: which sign was meant stands beside it."""
    found = {}
    for leaf in leaves:
        along = [dot(leaf.of[side], n).value for side in ("a", "b")] if leaf.kind == "dot" else []
        for cos in along:
            if abs(abs(cos) - 1.0) < SURE:
                found[id(leaf)] = leaf.value if cos > 0.0 else abs(leaf.value)
    return next(iter(found.values())) if len(found) == 1 else None


def used_or_right(leaves, kind, right):
    """The value of the one leaf of a kind; where there is none, what it has to be."""
    leaf = only(leaves, kind)
    return right() if leaf is None else leaf.value
