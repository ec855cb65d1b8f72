"""The Share menu in a real browser: downloads arrive, pages open from a file, strangers get nothing."""

import http.client
import json

import pytest
from suite import castray
from viewers import SMALL

pytestmark = pytest.mark.browser


def asked(server, path, **headers):
    """(status, headers, body) of a raw request."""
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=20)
    connection.request("GET", path, headers={"Host": f"127.0.0.1:{server.port}", **headers})
    reply = connection.getresponse()
    return reply.status, reply.headers, reply.read()


def test_strangers_get_nothing_and_friends_what_there_is(small):
    cookie = asked(small, f"/?key={small.key}")[1]["Set-Cookie"].partition(";")[0]
    assert asked(small, "/share/path.json")[0] == 403
    assert asked(small, f"/share/path.json?key={small.key}")[0] == 403
    assert asked(small, "/share/path.json", Cookie=cookie, Origin="http://evil.example")[0] == 403
    assert asked(small, "/share/path.json", Cookie=cookie, Host="evil.example")[0] == 403
    for name in ("nothing", "..%2fapp.py", "../app.py", "path.json%00", "__class__"):
        assert asked(small, f"/share/{name}", Cookie=cookie)[0] == 404
    status, headers, body = asked(small, "/share/path.json", Cookie=cookie)
    assert status == 200 and json.loads(body)["scene"] == "cornell_unit"
    assert headers["Content-Disposition"].startswith("attachment")
    assert headers["X-Content-Type-Options"] == "nosniff" and headers["Cache-Control"] == "no-store"


def test_files_are_downloaded_and_pages_open_without_a_network(small, visit, tmp_path):
    page = visit(small.address)
    page.get_by_test_id("share").locator("summary").click()
    for name in ("path.json", "view.html"):
        with page.expect_download() as download:
            page.get_by_test_id(f"share-{name}").click()
        download.value.save_as(tmp_path / name)
    c = page.evaluate("window.trame.trigger('truth', [])")["cursor"]
    where = ("--pixel", c["x"], c["y"], "--sample", c["path"], "--json")
    ran = castray("inspect", "cornell_unit", *SMALL, *where)
    assert json.loads((tmp_path / "path.json").read_text(encoding="utf-8")) == json.loads(ran.stdout)
    page.context.set_offline(True)
    alone = visit((tmp_path / "view.html").as_uri(), ready=False)
    alone.locator(f".castray-3d[data-event='{c['event']}']").wait_for()
    assert alone.errors == [] and {a.partition(":")[0] for a in alone.asked} <= {"file", "data"}
    page.context.set_offline(False)


def test_the_link_is_copied_and_names_the_event(small, visit, context):
    context.grant_permissions(["clipboard-read", "clipboard-write"])
    page = visit(small.address)
    page.get_by_test_id("row-3").click()
    page.locator("[data-testid=row-3][data-now=true]").wait_for()
    page.get_by_test_id("share").locator("summary").click()
    page.get_by_test_id("share-copy").click()
    page.get_by_test_id("share-copy").filter(has_text="copied").wait_for()
    copied = page.evaluate("navigator.clipboard.readText()")
    assert copied == page.get_by_test_id("share-link").input_value()
    assert copied.startswith("castray view '#scene=cornell_unit&") and copied.endswith("event=3'")
    page.keyboard.press("Escape")
    assert page.get_by_test_id("share").get_attribute("open") is None
