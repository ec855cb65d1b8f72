"""The viewer answers only the browser that was given its key, and nothing a client sends brings it down."""

import http.client
import socket

import msgpack
import pytest
from talking import chunk, talk

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def cookie(small):
    """The cookie that the printed address earns."""
    return answer(small, f"/?key={small.key}")[1]["Set-Cookie"].partition(";")[0]


def answer(server, path, **headers):
    """(status, headers, body) of one raw request."""
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=20)
    connection.putrequest("GET", path, skip_host=True)
    for name, value in {"Host": f"127.0.0.1:{server.port}", **headers}.items():
        connection.putheader(name, value)
    connection.endheaders()
    reply = connection.getresponse()
    return reply.status, reply.headers, reply.read().decode("utf-8", "replace")


def shake(**headers):
    """Headers of a WebSocket handshake."""
    return {
        "Connection": "Upgrade",
        "Upgrade": "websocket",
        "Sec-WebSocket-Version": "13",
        "Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAA==",
        **headers,
    }


def test_it_listens_on_the_loopback_address_only(small):
    outside = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    outside.settimeout(5)
    own = socket.gethostbyname(socket.gethostname())
    if own.startswith("127."):
        own = "127.0.0.2"  # on the loopback too, but not the address it was told to use
    with pytest.raises(OSError):
        outside.connect((own, small.port))
    outside.close()


@pytest.mark.parametrize("path", ["/", "/index.html", "/castray/castray.js", "/ws", "/nothing"])
def test_without_the_key_nothing_is_given(small, path):
    status, _, body = answer(small, path, **(shake() if path == "/ws" else {}))
    assert status == 403
    assert "<script" not in body


@pytest.mark.parametrize("key", ["", "wrong", "wslink-secret", "é"])
def test_a_wrong_key_is_refused(small, key):
    from urllib.parse import quote

    assert answer(small, f"/?key={quote(key)}")[0] == 403
    assert answer(small, "/", Cookie=f"castray-{small.port}={quote(key)}")[0] == 403


@pytest.mark.parametrize("origin", ["http://evil.example", "http://127.0.0.1:1", "https://127.0.0.1", "null"])
def test_a_foreign_origin_is_refused_even_with_the_key(small, cookie, origin):
    assert answer(small, "/ws", **shake(Origin=origin, Cookie=cookie))[0] == 403
    assert answer(small, f"/?key={small.key}", Origin=origin)[0] == 403


@pytest.mark.parametrize("host", ["evil.example", "evil.example:{port}", "127.0.0.1:1", "[::1]:{port}", ""])
def test_a_foreign_host_is_refused_even_with_the_key(small, cookie, host):
    host = host.format(port=small.port)
    assert answer(small, "/ws", **shake(Host=host, Cookie=cookie))[0] == 403
    assert answer(small, f"/?key={small.key}", Host=host)[0] in (400, 403)


def test_with_the_key_its_own_origin_is_let_in(small, cookie):
    own = f"http://127.0.0.1:{small.port}"
    assert answer(small, "/ws", **shake(Origin=own, Cookie=cookie))[0] == 101
    assert answer(small, "/", Cookie=cookie)[0] == 200


def test_the_page_forbids_foreign_code_and_frames(small, cookie):
    headers = answer(small, "/", Cookie=cookie)[1]
    policy = headers["Content-Security-Policy"]
    assert "default-src 'none'" in policy and "frame-ancestors 'none'" in policy
    assert "http:" not in policy and "*" not in policy
    earned = answer(small, f"/?key={small.key}")[1]["Set-Cookie"]
    assert "HttpOnly" in earned and "SameSite=Strict" in earned


def test_files_outside_the_served_folders_are_not_given(small, cookie):
    for path in (
        "/../pyproject.toml",
        "/castray/../app.py",
        "/castray/%2e%2e/app.py",
        "/fonts/..%2f__init__.py",
    ):
        assert answer(small, path, Cookie=cookie)[0] in (400, 403, 404)


BAD = [
    ("trame.state.update", [[{"key": "w", "value": {"title": "stolen"}}, {"key": "picture"}]]),
    ("trame.state.update", ["nonsense"]),
    ("trame.state.update", []),
    ("trame.trigger", []),
    ("trame.trigger", ["pick", ["a", 1], {}]),
    ("trame.trigger", ["pick", [-1, 0], {}]),
    ("trame.trigger", ["pick", [2**60, 0], {}]),
    ("trame.trigger", ["pick", [None, {"x": 1}], {}]),
    ("trame.trigger", ["pick", [1], {}]),
    ("trame.trigger", ["pick", {"x": 1}, {}]),
    ("trame.trigger", ["path", [True], {}]),
    ("trame.trigger", ["path", [1.5], {}]),
    ("trame.trigger", ["event", ["9" * 500], {}]),
    ("trame.trigger", ["at", [0], {}]),
    ("trame.trigger", ["at", [-1, {"x": 1}], {}]),
    ("trame.trigger", ["look", [["why"]], {}]),
    ("trame.trigger", ["go", ["__class__"], {}]),
    ("trame.trigger", ["go", [["next"]], {}]),
    ("trame.trigger", ["take", [{"a": 1}], {}]),
    ("trame.trigger", ["take", ["x" * 10**5], {}]),
    ("trame.trigger", ["open", ["scene=../../etc/passwd"], {}]),
    ("trame.trigger", ["open", ["scene=cornell_unit&x=9999&y=0"], {}]),
    ("trame.trigger", ["open", ["scene=cornell_unit&spp=0"], {}]),
    ("trame.trigger", ["open", [7], {}]),
    ("trame.trigger", ["back", [7], {}]),
    ("trame.trigger", ["find", [7], {}]),
    ("trame.trigger", ["doctor_examine", [7, 8], {}]),
    ("trame.trigger", ["doctor_go", ["0"], {}]),
    ("trame.trigger", ["doctor_go", [-1], {}]),
    ("trame.trigger", ["doctor_where", [0], {}]),
    ("trame.trigger", ["compare", ["/etc/passwd"], {}]),
    ("trame.trigger", ["open", ["scene=cornell_unit&compare=/etc/passwd"], {}]),
    ("trame.trigger", ["compare", [["D01"]], {}]),
    ("trame.trigger", ["compare_view", [7], {}]),
    ("trame.trigger", ["compare_path", [0], {}]),
    ("trame.trigger", ["compare_cause", ["0"], {}]),
    ("trame.trigger", ["compare_part", [], {}]),
    ("trame.trigger", ["compare_search", [], {}]),
    ("trame.trigger", ["find", ["x" * 20_000], {}]),
    ("trame.trigger", ["find", ["SELECT * FROM read_text('/etc/passwd')"], {}]),
    ("trame.trigger", ["find_stop", [["nan"]], {}]),
    ("trame.trigger", ["find_map", [{"name": "length"}], {}]),
    ("trame.trigger", ["find_hit", [-1], {}]),
    ("trame.trigger", ["find_hit", [10**9], {}]),
    ("trame.trigger", ["find_step", ["1"], {}]),
    ("trame.trigger", ["find_brush", [0, 1e9], {}]),
    ("trame.trigger", ["find_firefly", [None], {}]),
    ("trame.trigger", ["lesson_open", ["4"], {}]),
    ("trame.trigger", ["lesson_open", [True], {}]),
    ("trame.trigger", ["lesson_open", [99], {}]),
    ("trame.trigger", ["lesson_answer", ["radius", "5.67"], {}]),
    ("trame.trigger", ["lesson_answer", [{"id": 1}, "x" * 10**5], {}]),
    ("trame.trigger", ["lesson_hint", [7], {}]),
    ("trame.trigger", ["lesson_solution", ["radius"], {}]),
    ("trame.trigger", ["__init__", [], {}]),
    ("trame.trigger", [["go"], ["next"], {}]),
    ("viewport.geometry.array.get", ["no such array"]),
    ("viewport.geometry.array.get", []),
    ("trame.error.client", []),
    ("trame.force.push", ["rgb"]),
    ("application.exit", []),
    ("application.exit.later", [0]),
    ("viewport.image.render", [{"view": -1}]),
    ("file.server.directory.list", ["/"]),
]


@pytest.mark.parametrize("call", BAD, ids=lambda c: f"{c[0]} {str(c[1])[:40]}")
def test_a_bad_call_is_answered_without_a_traceback_and_changes_nothing(small, cookie, call):
    before, reply, after = talk(
        small, cookie, ("trame.trigger", ["truth", [], {}]), call, ("trame.trigger", ["truth", [], {}])
    )
    assert "Traceback" not in str(reply) and "File " not in str(reply)
    assert after["result"]["cursor"] == before["result"]["cursor"]
    assert after["result"]["link"] == before["result"]["link"]


def test_a_page_cannot_set_the_state(small, cookie):
    change = (
        "trame.state.update",
        [[{"key": "w", "value": {"title": "stolen"}}, {"key": "rgb", "value": "x"}]],
    )
    state = talk(small, cookie, change, ("trame.state.get", []))[1]["result"]["state"]
    assert state["w"]["title"] == "castray"
    assert state["rgb"] != "x"


@pytest.mark.parametrize(
    "raw", [b"", b"\xc1", b"\x00" * 64, chunk(b"\xff" * 40), chunk(msgpack.packb([1, 2]))]
)
def test_garbage_on_the_socket_leaves_the_server_up(small, cookie, raw):
    talk(small, cookie, raw=raw)
    assert talk(small, cookie, ("trame.trigger", ["truth", [], {}]))[0]["result"]["cursor"]
