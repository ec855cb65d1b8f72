"""Where there are no compute shaders, as on macOS, a fragment shader traces the same paths."""

from functools import partial

import numpy as np
import pytest
import same_paths
import shaders
import suite
from cases import loaded
from shaders import small
from suite import castray

import tracer
from tracer.engine.gl import device, tracing
from tracer.engine.gl.compute import Compute
from tracer.engine.gl.fragments import Fragments
from tracer.picture import read


@pytest.fixture(scope="module", autouse=True)
def gl():
    """OpenGL, drawn by whomever."""
    return suite.gl()


@pytest.fixture
def by(monkeypatch):
    """The picture of a scene by one kind of shader."""

    def render(runs, scene, **options):
        monkeypatch.setattr(tracing, "stage", lambda: runs)
        return tracer.render(scene, small(**options), engine="gl")

    return render


@pytest.mark.slow
@pytest.mark.parametrize("scene", [partial(loaded, "cornell_unit"), shaders.blob], ids=["box", "mesh"])
def test_both_kinds_of_shader_give_the_same_picture(by, scene):
    """Bit for bit on software GL; a driver may compile the two differently."""
    if device.stage() is not Compute:
        suite.missing("OpenGL 4.3")
    ours, theirs = (by(runs, scene()) for runs in (Fragments, Compute))
    assert (ours.rgb == theirs.rgb).mean() > 0.99 and abs(ours.rays - theirs.rays) <= 1e-4 * theirs.rays


@pytest.mark.slow
def test_tables_read_at_the_wrong_place_give_another_picture(by, monkeypatch):
    right = by(Fragments, loaded("cornell_unit")).rgb
    shaders.plant(monkeypatch, "ivec2(k % ACROSS", "ivec2((k + 1) % ACROSS")
    assert (
        not np.isclose(by(Fragments, loaded("cornell_unit")).rgb, right, rtol=1e-3).all(axis=2).mean() > 0.5
    )


@pytest.mark.slow
def test_its_paths_are_watched_vertex_by_vertex(monkeypatch):
    monkeypatch.setattr(tracing, "stage", lambda: Fragments)
    assert same_paths.share(loaded("cornell_unit"), small(spp=4)) >= 0.999


@pytest.mark.slow
def test_more_paths_than_a_row_of_the_picture_are_all_traced(by):
    """65,536 paths are 16 rows; the second render takes fewer than the first made room for."""
    whole = by(Fragments, loaded("furnace"), width=64, height=64, spp=16)
    assert whole.rays > whole.paths and not np.isnan(whole.rgb).any()
    part = by(Fragments, loaded("furnace"), width=64, height=64, spp=1)
    assert np.isclose(part.rgb.mean(), whole.rgb.mean(), rtol=0.05)


@pytest.mark.slow
def test_a_driver_of_opengl_4_1_draws_the_same_picture(tmp_path):
    """Mesa can be told to offer no more; of other drivers this asks nothing new."""
    words = "--size", 16, 16, "--spp", 4, "--max-depth", 8
    pictures = []
    for version in ("4.1", None):
        path = tmp_path / f"{version}.exr"
        env = {"MESA_GL_VERSION_OVERRIDE": version} if version else {}
        done = castray("render", "cornell_unit", "--engine", "gl", *words, "-o", path, env=env)
        assert done.returncode == 0, done.stderr
        pictures.append(read(path).rgb)
    assert (pictures[0] == pictures[1]).mean() > 0.99
