"""One small scene in Mitsuba's XML and as a dict, and how scenes are compared."""

import numpy as np

import tracer
from tracer import Settings

XML = """<?xml version="1.0" encoding="utf-8"?>
<scene version="3.0.0">
  <sensor type="perspective">
    <float name="fov" value="40"/>
    <transform name="to_world"><lookat origin="0,0,4" target="0,0,0" up="0 1 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="6"/></film>
  </sensor>
  <bsdf type="diffuse" id="white"><rgb name="reflectance" value="0.8, 0.7 0.6"/></bsdf>
  <shape type="rectangle" id="lamp">
    <ref id="white"/>
    <emitter type="area"><rgb name="radiance" value="1 2 3"/></emitter>
  </shape>
  <shape type="sphere" id="ball">
    <point name="center" x="0" y="0" z="1"/><float name="radius" value="0.5"/><ref id="white"/>
  </shape>
</scene>
"""
DICT = {
    "sensor": {
        "type": "perspective",
        "fov": 40.0,
        "to_world": [{"look_at": {"origin": [0, 0, 4], "target": [0, 0, 0], "up": [0, 1, 0]}}],
        "film": {"width": 8, "height": 6},
    },
    "white": {"type": "diffuse", "reflectance": [0.8, 0.7, 0.6]},
    "lamp": {"type": "rectangle", "bsdf": "white", "emitter": {"type": "area", "radiance": [1, 2, 3]}},
    "ball": {"type": "sphere", "center": [0, 0, 1], "radius": 0.5, "bsdf": "white"},
}
SMALL = Settings(width=8, height=6, spp=4, max_depth=6)


def same(a, b, settings=SMALL):
    """Two scenes make the same picture, bit for bit."""
    return np.array_equal(tracer.render(a, settings).rgb, tracer.render(b, settings).rgb)
