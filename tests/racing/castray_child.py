"""castray as a contestant: `castray_child.py SCENE.xml SIDE DEPTH PROCESSES`."""

import sys
import time
from importlib.metadata import version
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import tracer  # noqa: E402
from racing.contestant import serve  # noqa: E402


def main():
    path, side, depth, workers = sys.argv[1], *map(int, sys.argv[2:])
    scene = tracer.load(path)

    def render(spp, seed, how):
        began = time.perf_counter()
        how = dict(how)
        more = {"adaptive": how.pop("adaptive")} if "adaptive" in how else {}
        settings = tracer.Settings(width=side, height=side, spp=spp, seed=seed, max_depth=depth, **how)
        picture = tracer.render(scene, settings, workers=workers, **more)
        return picture.rgb, time.perf_counter() - began, picture.paths

    serve(version("castray"), render)


if __name__ == "__main__":
    main()
