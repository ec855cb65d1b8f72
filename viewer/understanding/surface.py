"""The material at recorded surface points: what it gives for any directions."""

import numpy as np

from tracer.frame import dot
from tracer.scene import Hit


def column(places, name):
    """A field of the events of Places, side by side, (..., N)."""
    return np.stack([np.asarray(place.event.values[name]) for place in places], axis=-1)


class Surface:
    """Materials at hits: values of recorded HIT events, one a lane. scene: at the record's settings.

    times: so often each. wo: (3, N) local directions back along the paths.
    """

    def __init__(self, scene, hits, times=1):
        def column(name):
            return np.repeat(np.stack([np.asarray(hit[name]) for hit in hits], axis=-1), times, axis=-1)

        self.scene, self.n, self.ng = scene, column("n"), column("ng")
        self.p, self.primitive = column("p"), column("primitive")
        self.t, self.front, self._wo = column("t"), column("front"), column("wo")
        self.frame = scene.frame(self.n, self.p, self.primitive)
        self.wo = self.frame.to_local(self._wo)
        self.material = scene.bsdf_of[self.primitive]
        self.texture = scene.painted(self.p, self.primitive)

    def f(self, wi):
        """The BSDF (3, N) from world directions wi (3, N) to wo; 0 where only the shading normal lets light
        through."""
        f = self.scene.bsdf.eval(self.material, self.wo, self.frame.to_local(wi), self.texture)
        return f * (dot(self.n, wi) * dot(self.ng, wi) > 0) if self.scene.has_smooth_normals else f

    def pdf(self, wi):
        """Density (N,) with which a bounce goes along world directions wi (3, N)."""
        return self.scene.bsdf.pdf(self.material, self.wo, self.frame.to_local(wi), self.texture)

    def sample(self, u):
        """Where bounces go that draw numbers u (3, N), as a Sample in the local frames."""
        return self.scene.bsdf.sample(self.material, self.wo, u, self.texture)

    def property(self, name, wi):
        """A named quantity behind f, (3, N), NaN where a material has none."""
        local = self.frame.to_local(wi)
        return self.scene.bsdf.property(self.material, name, self.wo, local, self.texture)

    def head_on(self, name):
        """The same quantity (3,) of the first hit with wo and wi along the normal."""
        up = np.zeros_like(self.wo)
        up[2] = 1.0
        return self.scene.bsdf.property(self.material, name, up, up, self.texture)[:, 0]

    def as_hit(self):
        """The hits as the steps of a tracer take them."""
        bound = self.scene.bound(self.p, self.ng, self.primitive)
        light = self.scene.light_of[self.primitive]
        return Hit(
            self.p,
            self.t,
            self.primitive,
            self.ng,
            self.n,
            self._wo,
            self.front,
            self.material,
            light,
            bound,
            self.texture,
        )
