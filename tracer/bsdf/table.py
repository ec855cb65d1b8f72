"""All materials of a scene as one: each lane is answered by its own, one pass per kind of material.

A kind is a class and its parameters that are not arrays, such as the distribution of normals.
"""

import numpy as np

from tracer.bsdf.sample import Sample


class BsdfTable:
    """Materials by number, grouped by kind with their parameters side by side.

    materials: sequence of material objects with one column each. dtype: precision of the parameters.
    hemisphere: how diffuse surfaces choose directions.
    """

    def __init__(self, materials, dtype, hemisphere):
        materials = [m.sampling(hemisphere) for m in materials]
        kinds = list(dict.fromkeys(m.kind for m in materials))
        kind = [kinds.index(m.kind) for m in materials]
        self._kind_of = np.array(kind, np.int32)
        self._single = [kind.count(number) == 1 for number in range(len(kinds))]
        self._row_of = np.array([kind[:i].count(k) for i, k in enumerate(kind)], np.int32)
        same = [[m for m in materials if m.kind == k] for k in kinds]
        self._kinds = [first.beside(others).astype(dtype) for first, *others in same]
        self._delta_of = np.array([m.delta for m in materials], bool)
        self._one_sided_of = np.array([m.one_sided for m in materials], bool)
        self._black_of = np.array([not np.any(m.albedo() > 0.0) for m in materials], bool)
        self.any_delta = bool(self._delta_of.any())
        self.all_delta = bool(self._delta_of.all())
        self._last = None, None
        self._plain = bool(self._one_sided_of.all() and not self._black_of.any())

    def is_delta(self, material):
        """Whether each material has nothing but Dirac lobes, for (N,) material numbers."""
        return self._delta_of.take(material)

    def reflects(self, material, wo):
        """Whether anything can be scattered towards wo (3, N): not black, and not seen from behind."""
        front = wo[2] > 0.0
        if self._plain:
            return front
        two_sided = ~self._one_sided_of.take(material)
        return (front | (two_sided & (wo[2] < 0.0))) & ~self._black_of.take(material)

    def eval(self, material, wo, wi):
        """f (3, N) in sr^-1."""
        return self._answer(material, lambda m, lanes: m.eval(wo[:, lanes], wi[:, lanes]))

    def pdf(self, material, wo, wi):
        """Density (N,) in sr^-1 with which sample would give wi."""
        return self._answer(material, lambda m, lanes: m.pdf(wo[:, lanes], wi[:, lanes]))

    def sample(self, material, wo, u):
        """A direction per lane, from u (3, N), as a Sample."""
        return self._answer(material, lambda m, lanes: m.sample(wo[:, lanes], u[:, lanes]))

    def property(self, material, name, wo, wi):
        """A named quantity behind f (see Material.explain), (3, N); NaN where a material has none."""

        def answer(m, lanes):
            to, at = wo[:, lanes], wi[:, lanes]
            return np.broadcast_to(m.explain(to, at).get(name, np.nan), to.shape).astype(wo.dtype)

        return self._answer(material, answer)

    def _answer(self, material, ask):
        """What `ask(material with parameters per lane, lanes)` gives, put together over the kinds."""
        if len(self._kinds) == 1:
            return ask(self._gathered(0, material), slice(None))
        kind = self._kind_of.take(material)
        parts = []
        for number in range(len(self._kinds)):
            lanes = np.flatnonzero(kind == number)
            if lanes.size or number == 0:
                parts.append((lanes, ask(self._gathered(number, material[lanes]), lanes)))
        if isinstance(parts[0][1], Sample):
            columns = zip(*(part for _, part in parts), strict=True)
            where = [lanes for lanes, _ in parts]
            return Sample(*(_scatter(where, column, material.size) for column in columns))
        return _scatter([lanes for lanes, _ in parts], [part for _, part in parts], material.size)

    def _gathered(self, number, material):
        """One kind with a parameter column per lane; a single material is broadcast instead."""
        kind = self._kinds[number]
        if self._single[number]:
            return kind
        if len(self._kinds) > 1:
            return kind.take(self._row_of.take(material))
        if self._last[0] is not material:  # eval, pdf and sample of one vertex ask for the same
            self._last = material, kind.take(self._row_of.take(material))
        return self._last[1]


def _scatter(where, parts, n):
    """One array of n lanes from parts and the lanes each belongs to."""
    whole = np.empty((*parts[0].shape[:-1], n), parts[0].dtype)
    for lanes, part in zip(where, parts, strict=True):
        whole[..., lanes] = part
    return whole
