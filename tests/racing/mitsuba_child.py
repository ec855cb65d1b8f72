"""Mitsuba 3 as a contestant: `mitsuba_child.py SCENE.xml SIDE DEPTH THREADS VARIANT`.

DRJIT_LIBLLVM_PATH names LLVM's library where the variant needs it.
"""

import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import drjit as dr  # noqa: E402
import mitsuba as mi  # noqa: E402
import numpy as np  # noqa: E402

from racing.contestant import serve  # noqa: E402
from racing.scene import for_mitsuba  # noqa: E402


def main():
    path, (side, depth, threads), variant = sys.argv[1], map(int, sys.argv[2:5]), sys.argv[5]
    mi.set_variant(variant)
    mi.set_log_level(mi.LogLevel.Error)
    dr.set_thread_count(threads)
    text, scenes = Path(path).read_text(encoding="utf-8"), {}

    def render(spp, seed, how):
        sampler = how["sampler"]
        if sampler not in scenes:
            scenes[sampler] = mi.load_string(for_mitsuba(text, side, depth, sampler))
        scene = scenes[sampler]
        began = time.perf_counter()
        image = mi.render(scene, spp=spp, seed=seed)
        dr.eval(image)
        dr.sync_thread()
        rgb = np.array(image)
        seconds = time.perf_counter() - began
        # Some samplers round the number of samples up.
        return rgb, seconds, scene.sensors()[0].sampler().sample_count() * side * side

    serve(mi.__version__, render)


if __name__ == "__main__":
    main()
