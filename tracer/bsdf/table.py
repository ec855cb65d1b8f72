"""All materials of a scene as one: each lane is answered by its own, one pass per kind of material.

A kind is a class and its parameters that are not arrays, such as the distribution of normals.
"""

from functools import reduce

import numpy as np

from tracer.bsdf.sample import Sample
from tracer.lanes import gather, put


class BsdfTable:
    """Materials by number, grouped by kind with their parameters side by side.

    materials: sequence of material objects with one column each. dtype: precision of the parameters.
    hemisphere: how diffuse surfaces choose directions. textures: for each material {parameter: texture}; the
    k-th of a material fills slot k of `painted`.
    """

    def __init__(self, materials, dtype, hemisphere, textures=()):
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
        self._anisotropic_of = np.array([m.anisotropic for m in materials], bool)
        self.any_anisotropic = bool(self._anisotropic_of.any())
        self.any_delta = bool(self._delta_of.any())
        self.all_delta = bool(self._delta_of.all())
        self._textures = {k: [t.astype(dtype) for t in of.values()] for k, of in enumerate(textures) if of}
        self.any_textured = bool(self._textures)
        self._slots = max(map(len, self._textures.values()), default=0)
        self._puts = [
            [put for put in self._all_puts(textures) if put[2][self._kind_of == number].any()]
            for number in range(len(kinds))
        ]
        self._last = None, None, None
        self._plain = bool(self._one_sided_of.all() and not self._black_of.any())

    def _all_puts(self, textures):
        """Which parameter each slot stands for: (its path, slot, whether so for each material (M,))."""
        places = [(name, slot) for of in textures for slot, name in enumerate(of)]
        for name, slot in dict.fromkeys(places):
            has = np.array([list(of).index(name) == slot if name in of else False for of in textures])
            yield name.split("."), slot, has

    def painted(self, material, p, primitive, uv):
        """What the textures of (N,) materials say at points p (3, N), (slots, 3, N); None if none has any.

        uv: gives the coordinates (2, M) of points on primitives; it is asked for those with a texture only.
        """
        values = None
        for number, textures in self._textures.items():
            lanes = np.flatnonzero(material == number)
            if not lanes.size:
                continue
            if values is None:
                values = np.zeros((self._slots, *p.shape), p.dtype)
            here = uv(gather(p, lanes), primitive[lanes])
            for slot, texture in enumerate(textures):
                values[slot][:, lanes] = texture.at(here)
        return values

    def is_delta(self, material):
        """Whether each material has nothing but Dirac lobes, for (N,) material numbers."""
        return gather(self._delta_of, material)

    def is_anisotropic(self, material):
        """Whether each material minds how its frame is turned about the normal."""
        return gather(self._anisotropic_of, material)

    def reflects(self, material, wo):
        """Whether anything can be scattered towards wo (3, N): not black, and not seen from behind."""
        front = wo[2] > 0.0
        if self._plain:
            return front
        two_sided = ~gather(self._one_sided_of, material)
        return (front | (two_sided & (wo[2] < 0.0))) & ~gather(self._black_of, material)

    def eval(self, material, wo, wi, texture=None):
        """f (3, N) in sr^-1. texture: what `painted` says, here and below."""
        return self._answer(material, texture, lambda m, lanes: m.eval(_some(wo, lanes), _some(wi, lanes)))

    def pdf(self, material, wo, wi, texture=None):
        """Density (N,) in sr^-1 with which sample would give wi."""
        return self._answer(material, texture, lambda m, lanes: m.pdf(_some(wo, lanes), _some(wi, lanes)))

    def sample(self, material, wo, u, texture=None):
        """A direction per lane, from u (3, N), as a Sample."""
        return self._answer(material, texture, lambda m, lanes: m.sample(_some(wo, lanes), _some(u, lanes)))

    def colour(self, material, texture=None):
        """The colour that stands for each material there, (3, N)."""

        def answer(m, lanes):
            return np.broadcast_to(m.display_colour(), (3, material[lanes].size))

        return self._answer(material, texture, answer)

    def property(self, material, name, wo, wi, texture=None):
        """A named quantity behind f (see Material.explain), (3, N); NaN where a material has none."""

        def answer(m, lanes):
            to, at = _some(wo, lanes), _some(wi, lanes)
            return np.broadcast_to(m.explain(to, at).get(name, np.nan), to.shape).astype(wo.dtype)

        return self._answer(material, texture, answer)

    def _answer(self, material, texture, ask):
        """What `ask(material with parameters per lane, lanes)` gives, put together over the kinds."""
        if len(self._kinds) == 1:
            return ask(self._gathered(0, material, texture), slice(None))
        kind = gather(self._kind_of, material)
        parts = []
        for number in range(len(self._kinds)):
            lanes = np.flatnonzero(kind == number)
            if lanes.size or number == 0:
                here = None if texture is None else texture.take(lanes, axis=2)
                parts.append((lanes, ask(self._gathered(number, material[lanes], here), lanes)))
        if isinstance(parts[0][1], Sample):
            columns = zip(*(part for _, part in parts), strict=True)
            where = [lanes for lanes, _ in parts]
            return Sample(*(_scatter(where, column, material.size) for column in columns))
        return _scatter([lanes for lanes, _ in parts], [part for _, part in parts], material.size)

    def _gathered(self, number, material, texture):
        """One kind with a parameter column per lane; a single material in one colour is broadcast instead."""
        kind, puts = self._kinds[number], () if texture is None else self._puts[number]
        if self._single[number] and not puts:
            return kind
        if len(self._kinds) > 1:
            return self._with_textures(kind.take(gather(self._row_of, material)), puts, material, texture)
        if self._last[0] is not material or self._last[1] is not texture:
            # eval, pdf and sample of one vertex ask for the same
            taken = self._with_textures(kind.take(gather(self._row_of, material)), puts, material, texture)
            self._last = material, texture, taken
        return self._last[2]

    def _with_textures(self, kind, puts, material, texture):
        """Columns of its own, with what textures say in the place of parameters."""
        for (*inside, parameter), slot, has in puts:
            lanes = np.flatnonzero(gather(has, material))
            column = getattr(reduce(getattr, inside, kind), parameter)
            column[:, lanes] = gather(texture[slot], lanes)
        return kind


def _some(w, lanes):
    """Columns of w (3, N) at some lanes."""
    return w if isinstance(lanes, slice) else gather(w, lanes)


def _scatter(where, parts, n):
    """One array of n lanes from parts and the lanes each belongs to."""
    whole = np.empty((*parts[0].shape[:-1], n), parts[0].dtype)
    for lanes, part in zip(where, parts, strict=True):
        put(whole, lanes, part)
    return whole
