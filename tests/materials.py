"""The materials that tests go through, as scenes describe them."""

LOSSLESS = {
    "mirror": {"type": "conductor"},
    "glass": {"type": "dielectric"},
    "schlick glass": {"type": "dielectric", "int_ior": 2.0, "fresnel": "schlick"},
    "pane": {"type": "thindielectric"},
    "white plastic": {"type": "plastic", "diffuse_reflectance": 1.0},
    "deep white plastic": {"type": "plastic", "diffuse_reflectance": 1.0, "nonlinear": True},
}
LOSSY = {
    "diffuse": {"type": "diffuse", "reflectance": 0.6},
    "gold": {"type": "conductor", "material": "Au"},
    "rough mirror": {"type": "roughconductor", "alpha": 0.4, "distribution": "ggx"},
    "brushed gold": {"type": "roughconductor", "material": "Au", "alpha_u": 0.05, "alpha_v": 0.5},
    "rough glass": {"type": "roughdielectric", "alpha": 0.3, "int_ior": 1.5, "distribution": "ggx"},
    "plastic": {"type": "plastic", "diffuse_reflectance": [0.8, 0.3, 0.1]},
    "rough plastic": {"type": "roughplastic", "alpha": 0.2, "diffuse_reflectance": 1.0},
    "two-sided": {"type": "twosided", "bsdf": {"type": "plastic"}},
}
MATERIALS = LOSSLESS | LOSSY
