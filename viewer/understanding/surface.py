"""The material at recorded surface points: what it gives for any directions."""

import numpy as np

from tracer.frame import dot


class Surface:
    """Materials at hits: values of recorded HIT events, one a lane. scene: at the record's settings.

    wo: (3, N) local directions back along the paths.
    """

    def __init__(self, scene, hits):
        def column(name):
            return np.stack([np.asarray(hit[name]) for hit in hits], axis=-1)

        self.scene, self.n, self.ng = scene, column("n"), column("ng")
        p, primitive = column("p"), column("primitive")
        self.frame = scene.frame(self.n, p, primitive)
        self.wo = self.frame.to_local(column("wo"))
        self.material, self.texture = scene.bsdf_of[primitive], scene.painted(p, primitive)

    def f(self, wi):
        """The BSDF (3, N) from world directions wi (3, N) to wo; 0 where only the shading normal lets light
        through."""
        f = self.scene.bsdf.eval(self.material, self.wo, self.frame.to_local(wi), self.texture)
        return f * (dot(self.n, wi) * dot(self.ng, wi) > 0) if self.scene.has_smooth_normals else f

    def pdf(self, wi):
        """Density (N,) with which a bounce goes along world directions wi (3, N)."""
        return self.scene.bsdf.pdf(self.material, self.wo, self.frame.to_local(wi), self.texture)

    def property(self, name, wi):
        """A named quantity behind f, (3, N), NaN where a material has none."""
        local = self.frame.to_local(wi)
        return self.scene.bsdf.property(self.material, name, self.wo, local, self.texture)
