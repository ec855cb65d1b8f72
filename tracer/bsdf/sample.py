"""What a BSDF answers when it is asked for a direction, and what all materials have in common."""

from dataclasses import fields, replace
from typing import NamedTuple

import numpy as np

from tracer.lanes import gather


class Sample(NamedTuple):
    """One sampled direction per lane, with what eval and pdf say about it."""

    wi: np.ndarray  # (3, N) local direction
    f: np.ndarray  # (3, N) BSDF in sr^-1; the scattered fraction at a Dirac lobe
    pdf: np.ndarray  # (N,) density in sr^-1; a probability at a Dirac lobe
    delta: np.ndarray  # (N,) whether the lobe is a Dirac one
    lobe: np.ndarray  # (N,) index into events.LOBES

    def take(self, lanes):
        """The samples of some lanes."""
        return Sample(*(gather(column, lanes) for column in self))


class Material:
    """What all materials share.

    Parameters that are arrays have one column per material or lane. All others (the name of a distribution,
    a switch, a material inside) belong to the kind: only materials that agree in them are answered together.
    """

    delta = False  # whether all lobes are Dirac ones
    one_sided = True  # whether it scatters on the side of the normal only
    see_through = False  # whether light passes to the other side
    thin = False  # whether there is nothing between the sides: two faces taken for one
    vanishes = False  # whether light passes as if nothing were there
    anisotropic = False  # whether it minds being turned about the normal

    @property
    def kind(self):
        """What materials must agree in to be answered in one pass."""
        values = (getattr(self, f.name) for f in fields(self))
        return type(self), *(
            v.kind if isinstance(v, Material) else v for v in values if not isinstance(v, np.ndarray)
        )

    def take(self, row):
        """The same material with the columns `row` (N,) of its parameters."""
        return self._changed(lambda value: gather(value, row), lambda inside: inside.take(row))

    def astype(self, dtype):
        """The same material with floating point parameters of another precision."""
        return self._changed(lambda value: value.astype(dtype), lambda inside: inside.astype(dtype))

    def sampling(self, hemisphere):
        """The same material with diffuse directions chosen in this way."""
        changed = self._changed(lambda value: value, lambda inside: inside.sampling(hemisphere))
        return replace(changed, hemisphere=hemisphere) if hasattr(self, "hemisphere") else changed

    def beside(self, others):
        """This and other materials of the same kind as one, a parameter column each."""
        joined = {}
        for f in fields(self):
            values = [getattr(m, f.name) for m in (self, *others)]
            if isinstance(values[0], np.ndarray):
                joined[f.name] = np.concatenate(values, axis=-1)
            elif isinstance(values[0], Material):
                joined[f.name] = values[0].beside(values[1:])
        return replace(self, **joined)

    def explain(self, wo, wi):
        """Quantities behind f for two directions, {name: array}: those of eta, F, D, G1, G2 that apply."""
        return {}

    def _changed(self, array, inside):
        changed = {}
        for f in fields(self):
            value = getattr(self, f.name)
            if isinstance(value, np.ndarray):
                changed[f.name] = array(value)
            elif isinstance(value, Material):
                changed[f.name] = inside(value)
        return replace(self, **changed)


class Dirac(Material):
    """What materials share that have nothing but Dirac lobes."""

    delta = True

    def eval(self, wo, wi):
        """0: a Dirac lobe has no value in any given direction."""
        return np.zeros_like(wo)

    def pdf(self, wo, wi):
        """0, as for eval."""
        return np.zeros_like(wo[2])
