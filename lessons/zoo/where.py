"""Which hits a mistake touches: those of some shapes, those of some materials."""

import numpy as np


def of_shape(scene, primitive, *kinds):
    """Whether primitives (N,) belong to shapes of some classes, (N,); -1 belongs to none."""
    table = np.array([isinstance(shape, kinds) for shape in scene.shapes])
    return table.take(scene.shape_of.take(primitive)) & (primitive >= 0)


def of_material(scene, hit, *kinds):
    """Whether the material of each hit is of some classes, (N,)."""
    table = np.array([isinstance(material, kinds) for material in scene.definition.bsdfs.values()])
    return table.take(hit.bsdf)


def explained(scene, hit, name, wo, wi):
    """A quantity behind f, such as eta, F, D or G1, (N,); NaN where a material has none."""
    return scene.bsdf.property(hit.bsdf, name, wo, wi, hit.texture)[0]


def mixed(which, ours, theirs):
    """A record of arrays with the columns of `ours` where `which` (N,), of `theirs` elsewhere."""
    pairs = zip(ours, theirs, strict=True)
    return type(theirs)(*(np.where(which, a, b).astype(b.dtype) for a, b in pairs))
