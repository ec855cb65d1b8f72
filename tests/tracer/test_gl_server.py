"""The gl engine in a process of its own: the same pictures, stopped and lost without harm."""

import numpy as np
import pytest
import suite
from cases import loaded

import tracer
from lessons import zoo
from tracer import Settings, TracerError
from tracer.engine.gl import server as servers
from tracer.engine.gl.device import is_hardware
from tracer.engine.gl.server import Server
from tracer.integrator.steps import RIGHT

SETTINGS = Settings(width=16, height=16, spp=4, max_depth=6)

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def server():
    """One process for the tests of this file."""
    suite.gl()
    started = Server()
    yield started
    started.close()
    assert not started._child.is_alive()


def here(scene="cornell_unit"):
    """The picture that the engine makes in this process."""
    return tracer.render(loaded(scene), SETTINGS, engine="gl")


def there(server, scene="cornell_unit", steps=RIGHT, progress=lambda done, total: None, meanwhile=None):
    return server.render(loaded(scene), SETTINGS, steps, progress, meanwhile)


def test_the_picture_is_that_of_the_engine(server):
    ours, theirs = here(), there(server)
    assert np.array_equal(ours.rgb, theirs.rgb) and np.array_equal(ours.variance, theirs.variance)
    assert (theirs.engine, theirs.rays, theirs.complete) == ("gl", ours.rays, True)
    assert server.renderer


def test_what_gl_cannot_do_is_refused_by_name_and_the_next_picture_is_made(server):
    with pytest.raises(TracerError, match="gl cannot do a replaced step: emission_weight"):
        there(server, steps=zoo.steps("E01"))
    assert np.array_equal(there(server, "furnace").rgb, here("furnace").rgb)


def test_one_that_is_stopped_leaves_the_process_to_the_next(server):
    def stop(done, total):
        if done:
            raise KeyError

    with pytest.raises(KeyError):
        there(server, progress=stop)
    assert np.array_equal(there(server, "furnace").rgb, here("furnace").rgb)


def test_while_nothing_is_heard_something_else_is_done_once(server, monkeypatch):
    monkeypatch.setattr(servers, "PATIENCE", 0.0)
    done = []
    picture = there(server, "sky", meanwhile=lambda: done.append(0))
    assert done == [0] and picture.engine == "gl"


def test_whoever_waits_for_another_picture_does_something_else_meanwhile(server):
    server._free.acquire()
    assert there(server, meanwhile=server._free.release).engine == "gl"


def test_a_process_that_is_lost_says_so_once_and_for_all():
    suite.gl()
    lost = Server()
    lost.greet()
    lost._child.kill()
    for _ in range(2):
        with pytest.raises(TracerError, match="the process that traces by gl has ended"):
            there(lost)
    lost.close()


def test_auto_leaves_to_numpy_what_the_processor_would_draw():
    suite.gl()
    auto = Server(auto=True)
    try:
        if is_hardware():
            assert there(auto).engine == "gl"
        else:
            with pytest.raises(TracerError, match="OpenGL is drawn by the processor here"):
                there(auto)
    finally:
        auto.close()
