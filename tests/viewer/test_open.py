"""Files from the page: what is opened, what is refused in one clear line; nothing is left lying about."""

import http.client
import json
import re
import tempfile

import numpy as np
import pytest
from suite import ROOT

import tracer
from tracer.picture import StoredPicture
from tracer.settings import ANY_DEPTH
from viewer import picture_examining
from viewer.opening.uploads import LARGEST, MOST_PIXELS, check_size, named, opened
from viewer.panels import all_panels
from viewer.panels import given as given_panel
from viewer.panels import picture as picture_panel
from viewer.session import Session
from viewer.understanding.why import why
from viewer.words import Speaker
from viewer.worker import outcome

SCENES = ROOT / "scenes"
TOML = (SCENES / "furnace.toml").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("name", "kept"),
    [
        ("mine.toml", "mine.toml"),
        ("../../etc/passwd.xml", "passwd.xml"),
        (r"D:\work\My Scene.TOML", "My_Scene.toml"),
        ("a" * 500 + ".png", "a" * 64 + ".png"),
        ("…/\x00<script>.exr", "script.exr"),
        ("..jsonl", "file.jsonl"),
        ("作业/张三 的图.png", "张三_的图.png"),
        ("\U00020000" * 64 + ".png", "\U00020000" * 50 + ".png"),
    ],
)
def test_of_a_name_from_outside_harmless_characters_are_kept(name, kept):
    assert named(name) == kept


@pytest.mark.parametrize("name", ["", "passwd", "evil.py", "a.toml.sh", "x.html", "a.svg", "toml"])
def test_other_kinds_of_files_are_refused(name):
    with pytest.raises(tracer.TracerError, match="none of the files that are opened"):
        named(name)


@pytest.mark.parametrize("ending", LARGEST)
def test_what_is_too_large_is_refused(ending):
    check_size(f"a{ending}", LARGEST[ending])
    with pytest.raises(tracer.TracerError, match=r"larger than \d+ MB"):
        check_size(f"a{ending}", LARGEST[ending] + 1)


BITMAP = '[w]\ntype = "diffuse"\nreflectance = { type = "bitmap", filename = "/etc/passwd" }\n'
XML = '<scene version="3.0.0">%s</scene>'
BAD = {
    "a.toml": [b"\xff\xfe", b"[[[", TOML.encode() + BITMAP.encode(), b"a = " + b"[" * 9000],
    "a.xml": [
        b"",
        (XML % '<include filename="/etc/passwd"/>').encode(),
        (XML % '<shape type="ply"><string name="filename" value="/etc/passwd"/></shape>').encode(),
        b'<!DOCTYPE x [<!ENTITY a SYSTEM "file:///etc/passwd">]><scene version="3.0.0">&a;</scene>',
    ],
    "a.jsonl": [b"", b"{", b'{"castray": 1}\n', b"\x00" * 99],
    "a.png": [b"", b"GIF89a", b"\x89PNG\r\n\x1a\n" + b"\x00" * 40],
    "a.exr": [b"", b"\x76\x2f\x31\x01" + b"\x00" * 50],
    "a.npy": [b"", b"\x93NUMPY\x01\x00"],
    "furnace.toml": [TOML.encode()],
}


@pytest.mark.parametrize(("name", "data"), [(n, d) for n, several in BAD.items() for d in several])
def test_what_will_not_do_is_said_in_one_line_that_names_no_folder(name, data, monkeypatch, tmp_path):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    with pytest.raises(tracer.TracerError) as refused:
        opened(name, data, tracer.load("furnace"))
    said = str(refused.value)
    assert "\n" not in said and str(tmp_path) not in said
    assert list(tmp_path.iterdir()) == []  # nothing is left


def test_a_picture_that_unpacks_to_too_much_is_refused_by_its_header(tmp_path):
    from PIL import Image

    Image.new("L", (MOST_PIXELS, 2)).save(tmp_path / "bomb.png")
    with pytest.raises(tracer.TracerError, match="pixels, more than"):
        opened("bomb.png", (tmp_path / "bomb.png").read_bytes(), None)


def test_scenes_and_pictures_are_what_they_are_by_the_command(tmp_path):
    upload = opened("mine.toml", TOML.encode("utf-8"), None)
    assert upload.scene.name == "mine" and len(upload.scene.shapes) == len(tracer.load("furnace").shapes)
    np.save(tmp_path / "p.npy", np.full((4, 6, 3), 0.5, np.float32))
    upload = opened("p.npy", (tmp_path / "p.npy").read_bytes(), None)
    assert upload.rival.picture.rgb.shape == (4, 6, 3) and upload.rival.name == "p.npy"


class Now:
    """A worker and a window that do at once what they are asked."""

    def do(self, job, done, failed):
        call, told = outcome(job, done, failed)
        call(told)

    def show(self, panel):
        """Nobody looks."""


def test_the_doctor_reads_a_compared_picture_that_came_from_the_page(tmp_path, monkeypatch):
    tracer.write(StoredPicture(np.full((16, 16, 3), 0.5, np.float32)), tmp_path / "mine.png")
    upload = opened("mine.png", (tmp_path / "mine.png").read_bytes(), None)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.png").write_bytes(b"another file of that name, where the viewer was started")
    session = Session(tracer.load("furnace"), tracer.Settings(width=16, height=16, spp=1), tracer.load)
    session.rivals["mine.png"], session.against = upload.rival, "mine.png"
    monkeypatch.setattr(picture_examining, "opinion_on", lambda given, scene, progress: (given, None))
    now = Now()
    now.session = session
    picture_examining.Guesser(now, now).guess()
    guess = picture_examining.guess_of(session)
    assert guess.error is None and guess.opinion[0].shape == (16, 16, 3)


def test_a_log_that_says_only_what_paths_bring_opens_with_its_reasons():
    ends = [
        {
            "path": 4 * x + k,
            "x": x,
            "y": 2,
            "sample": k,
            "kind": "end",
            "radiance": [9.0 * (k == 0), least, 0.0],
        }
        for x, least in ((1, 0.0), (2, -1.0))
        for k in range(4)
    ]
    lines = [{"castray": 1, "tracer": "mine"}, *ends]
    given = opened("a.jsonl", "\n".join(map(json.dumps, lines)).encode(), tracer.load("furnace")).given
    bright, negative = (why(given.record(x, 2), given.scene, own=False) for x in (1, 2))
    assert "negative" in [reason.key for reason in negative]
    assert not {"negative", "alone"} & {reason.key for reason in bright}


UP = {"x": 3, "y": 4, "depth": 0, "wi": [0.0, 1.0, 0.0]}
ODD = {
    "light samples alone": [
        {**UP, "sample": 0, "kind": "light", "visible": False, "contribution": [0, 0, 0]}
    ],
    "bounces alone": [{**UP, "sample": 0, "kind": "bounce", "pdf": 0.3, "f": [0.1, 0.1, 0.1]}],
    "some ends": [
        {**UP, "sample": 0, "kind": "camera", "film": [3.5, 4.5]},
        {**UP, "sample": 0, "kind": "hit", "p": [0, 0, 0], "contribution": [1, 1, 1]},
        {**UP, "sample": 0, "kind": "end", "radiance": [1, 1, 1], "reason": "absorbed"},
        {**UP, "sample": 1, "kind": "hit", "p": [0, 0, 0], "contribution": [2, 2, 2]},
    ],
    "as long as any": [{**UP, "sample": 0, "kind": "end", "radiance": [0, 0, 0], "reason": "max_depth"}],
}


@pytest.mark.parametrize("lines", ODD.values(), ids=ODD)
def test_every_panel_shows_paths_of_which_little_is_logged(lines):
    header = {"castray": 1, "tracer": "mine", "width": 8, "height": 8}
    data = "\n".join(json.dumps(line) for line in (header, *lines)).encode()
    given = opened("a.jsonl", data, tracer.load("cornell_unit")).given
    session, say = Session(given.scene, given.settings, tracer.load), Speaker("en")
    session.give(given)
    session.picture = given.picture
    for event in range(len(session.path.events)):
        session.cursor = session.cursor.at(event)
        for panel in all_panels():
            assert str(ANY_DEPTH) not in str(panel.show(session, say))  # which the log does not say


def test_where_a_log_has_one_pixel_in_so_many_a_click_beside_it_means_it():
    places = [(x, y) for y in (0, 4) for x in (0, 4)]
    lines = [{"kind": "end", "x": x, "y": y, "sample": 0, "radiance": [x, y, 1]} for x, y in places]
    header = {"castray": 1, "tracer": "mine", "width": 8, "height": 8}
    data = "\n".join(json.dumps(line) for line in (header, *lines)).encode()
    given = opened("a.jsonl", data, tracer.load("cornell_unit")).given
    session = Session(given.scene, given.settings, tracer.load)
    session.give(given)
    assert session.given.near(6, 1) == (4, 0)
    assert session.spread(given.picture.rgb)[1, 6].tolist() == [4, 0, 1]
    assert "one pixel in 4 × 4" in given_panel.show(session, Speaker("en"))["said"]
    shown = picture_panel.show(session, Speaker("en"))
    assert (shown["first"], shown["step"]) == ((0, 0), (4, 4))


def sent(server, name, data, **headers):
    """(status, text) of a file that is sent."""
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=30)
    connection.request("POST", f"/open?name={name}", data, {"Host": f"127.0.0.1:{server.port}", **headers})
    reply = connection.getresponse()
    return reply.status, reply.read().decode("utf-8")


@pytest.mark.browser
def test_the_page_opens_scenes_and_files_and_says_what_will_not_do(small, visit, tmp_path):
    page = visit(small.address)
    assert sent(small, "a.toml", TOML.encode())[0] == 403  # a stranger
    jar = page.context.cookies()[0]
    cookie = f"{jar['name']}={jar['value']}"
    assert sent(small, "a.toml", b"", Cookie=cookie, Origin="http://evil.example")[0] == 403
    status, text = sent(small, "a.toml", b"x" * (LARGEST[".toml"] + 1), Cookie=cookie)
    assert status == 422 and text == "open: a.toml is larger than 1 MB"

    page.get_by_test_id("open").locator("summary").click()
    page.get_by_test_id("open-furnace").click()
    page.wait_for_function("() => document.querySelector('[data-testid=scene]').innerText === 'furnace'")

    files = {"mine.toml": TOML, "broken.toml": "[[[", "notes.txt": "hello"}
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    np.save(tmp_path / "mine.npy", np.full((8, 8, 3), 0.5, np.float32))
    page.get_by_test_id("open").locator("summary").click()
    field, error = page.get_by_test_id("open-file"), page.get_by_test_id("open-error")
    for name, said in (("notes.txt", "none of the files"), ("broken.toml", "is not correct TOML")):
        field.set_input_files(tmp_path / name)
        page.wait_for_function(
            "said => document.querySelector('[data-testid=open-error]')?.innerText.includes(said)", arg=said
        )
        assert str(tmp_path) not in error.inner_text() and not re.search(r"castray-\w+/", error.inner_text())
    field.set_input_files(tmp_path / "mine.toml")
    page.wait_for_function("() => document.querySelector('[data-testid=scene]').innerText === 'mine'")
    page.get_by_test_id("open").locator("summary").click()
    field.set_input_files(tmp_path / "mine.npy")
    page.wait_for_function("() => document.querySelector('[data-testid=rival]')?.value === 'mine.npy'")
    assert page.get_by_test_id("settings").inner_text().startswith("8×8")
    assert [e for e in page.errors if "422" not in e] == []
