"""How the viewer starts, says where it is, and ends."""

import re
import signal
import sys

import pytest
from suite import castray
from viewers import SMALL

pytestmark = pytest.mark.slow


def test_it_prints_its_address_alone_on_one_line(serve):
    server = serve("cornell_unit", *SMALL)
    assert re.fullmatch(r"http://127\.0\.0\.1:\d+/\?key=[\w-]{20,}", server.address)


@pytest.mark.slow
def test_every_start_has_a_key_of_its_own(serve):
    assert serve("furnace", *SMALL).key != serve("furnace", *SMALL).key


def test_it_listens_where_it_is_told(serve):
    first = serve("furnace", *SMALL)
    port = first.port
    first.stop()
    assert serve("furnace", *SMALL, "--port", str(port)).port == port


@pytest.mark.slow
def test_a_port_that_is_taken_is_one_clear_line(serve):
    port = serve("furnace", *SMALL).port
    ran = castray("view", "furnace", "--no-browser", "--port", port, timeout=60)
    assert ran.returncode == 2
    assert ran.stdout == ""
    assert len(ran.stderr.splitlines()) == 1 and str(port) in ran.stderr


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="Ctrl-C cannot be sent to another process alone")
def test_ctrl_c_ends_it_without_a_traceback(serve):
    server = serve("cornell_unit", "--spp", "4096")
    server.process.send_signal(signal.SIGINT)
    out, said = server.process.communicate(timeout=20)
    assert server.process.returncode == 0
    assert "Traceback" not in said and out == ""


@pytest.mark.slow
@pytest.mark.parametrize(
    "link",
    [
        "http://127.0.0.1:1/#scene=nowhere&x=1&y=1",
        "http://127.0.0.1:1/#scene=../cornell&x=1&y=1",
        "http://127.0.0.1:1/#scene=furnace&x=9999&y=1",
        "http://127.0.0.1:1/#scene=furnace&spp=4&x=1&y=1&path=4",
        "http://127.0.0.1:1/#scene=furnace&spp=4&x=1&y=1&path=0&event=9999",
        "http://127.0.0.1:1/#scene=furnace&spp=none",
        "http://127.0.0.1:1/",
    ],
)
def test_a_bad_link_is_one_clear_line(link):
    ran = castray("view", link, "--no-browser", timeout=60)
    assert ran.returncode == 2
    assert ran.stdout == ""
    assert len(ran.stderr.splitlines()) == 1
