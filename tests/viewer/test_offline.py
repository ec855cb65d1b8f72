"""A page that stands alone shows a pixel's paths in 3D from a file, and asks nobody for anything."""

import base64
import io
import json
import re

import numpy as np
import pytest
from PIL import Image

import tracer
from lessons.zoo import planted
from viewer.cursor import Cursor
from viewer.hemisphere import Hemisphere
from viewer.offline import View, page
from viewer.understanding import lens
from viewer.words import Speaker

SCENE = tracer.load("cornell_unit")
SETTINGS = tracer.Settings(width=24, height=24, spp=4, max_depth=4)


def record(settings=SETTINGS, scene=SCENE, x=16, y=20):
    return tracer.inspect(scene, settings, x, y, steps=planted(settings))


def made(language="en"):
    """The page of a pixel, and the Cursor it opens at."""
    found = record()
    cursor = Cursor(16, 20, tuple(len(path.events) for path in found.paths), 1, 2)
    rgb = np.zeros((24, 24, 3), np.float32)
    return page(SCENE, found, cursor, Speaker(language), rgb), cursor, found


@pytest.mark.browser
def test_it_opens_from_a_file_with_no_request_and_walks_by_keys_and_mouse(tmp_path, visit):
    html, cursor, found = made()
    file = tmp_path / "paths.html"
    file.write_text(html, encoding="utf-8")
    tab = visit(file.as_uri(), ready=False)
    view = tab.locator(".castray-3d")

    def at(path, event):
        tab.locator(f".castray-3d[data-path='{path}'][data-event='{event}']").wait_for()

    at(1, 2)
    assert np.unique(pixels(tab), axis=0).shape[0] > 50  # walls, lines and balls, and not one empty field
    view.locator("canvas").press("ArrowRight")
    at(1, 3)
    view.locator("canvas").press("End")
    at(1, len(found.paths[1].events) - 1)
    view.get_by_label("Next path (↓)").click()
    at(2, 0)
    before = pixels(tab)
    box = view.locator("canvas").bounding_box()
    tab.mouse.move(box["x"] + 100, box["y"] + 100)
    tab.mouse.down()
    tab.mouse.move(box["x"] + 220, box["y"] + 130, steps=3)
    tab.mouse.up()
    assert (pixels(tab) != before).any()
    assert tab.errors == []
    assert [address for address in tab.asked if not address.startswith("data:")] == [file.as_uri()]


@pytest.mark.browser
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_it_is_light_or_dark_as_the_browser_is_and_its_3d_view_always_dark(tmp_path, visit, scheme):
    file = tmp_path / "paths.html"
    file.write_text(made()[0], encoding="utf-8")
    tab = visit(file.as_uri(), ready=False)
    tab.emulate_media(color_scheme=scheme)
    tab.locator(".castray-3d[data-event='2']").wait_for()

    def bright(selector, what):
        colour = tab.locator(selector).first.evaluate("(e, what) => getComputedStyle(e)[what]", what)
        return sum(map(int, re.findall(r"\d+", colour)[:3])) / 3

    for place, back in (
        ("body", "body"),
        (".castray-3d .told", ".castray-3d"),
        (".bar button", ".bar button"),
    ):
        light, dark = bright(back, "backgroundColor"), bright(place, "color")
        assert (light > 150 > dark) == (scheme == "light") and abs(light - dark) > 120
    assert bright(".castray-3d .home", "color") > bright(".stage", "backgroundColor") + 150


@pytest.mark.browser
def test_a_word_stands_only_where_what_it_names_is_seen(tmp_path, visit):
    file = tmp_path / "paths.html"
    file.write_text(made()[0], encoding="utf-8")
    tab = visit(file.as_uri(), ready=False)
    seen = tab.locator(".castray-3d .label:not([hidden])")
    tab.locator(".castray-3d[data-event='2']").wait_for()
    assert seen.count() == 3  # n, wo and wi
    tab.locator("canvas").press("Home")  # the camera stands before the box, outside the view
    tab.locator(".castray-3d[data-event='0']").wait_for()
    assert tab.locator(".castray-3d .label").count() == 1 and seen.count() == 0


def pixels(tab):
    """What the 3D view shows, (N, 3)."""
    shot = tab.locator(".castray-3d canvas").screenshot()
    return np.asarray(Image.open(io.BytesIO(shot)).convert("RGB")).reshape(-1, 3)


def test_the_hemisphere_stands_over_the_event_at_which_the_page_opens():
    settings = SETTINGS.at_size_of(SCENE)
    found = record()
    cursor = Cursor(16, 20, tuple(len(path.events) for path in found.paths), 1, 2)
    over = Hemisphere(lens.over(SCENE.at(settings), planted(settings), found, 1, 2), 2.0, Speaker("en"))
    view = View(Speaker("en"))
    view.add("", SCENE, (16, 20), found.paths, 1, 2, over=over)
    told = json.loads(view.script())["places"][0]["over"]
    assert (told["path"], told["event"]) == (1, 2)
    widths = [mesh["width"] for mesh in told["meshes"]]
    assert widths.count(2) == 2 and widths[-1] == 3  # shell and p are lines, f comes last
    drawn = over.drawn["lobe_f"][0].astype("<f4").tobytes()
    assert base64.b64decode(told["meshes"][-1]["points"]) == drawn
    assert page(SCENE, found, cursor, Speaker("en")).count('"over":null') == 1


def test_the_page_names_nothing_outside_itself_and_speaks_its_language():
    html, _, _ = made("zh")
    assert not re.search(r"(?:src|href)=[\"'](?!data:)", html) and "url(" not in html and "http" not in html
    assert 'lang="zh"' in html and "像素 (16, 20)" in html


def test_what_a_path_has_no_number_for_is_left_out_and_nothing_ends_the_script_early():
    settings = tracer.Settings(spp=4, bug="S02")
    pool = tracer.load("pool")
    view = View(Speaker("en"))
    found = record(settings.at_size_of(pool), pool, 175, 96)
    view.add("</script>", pool, (175, 96), found.paths)
    text = view.script()
    assert "</script>" not in text
    (place,) = json.loads(text)["places"]
    assert place["name"] == "</script>" and len(place["paths"]) == 4
    assert all(0 <= e["reached"] < len(p["line"]) for p in place["paths"] for e in p["events"])


def test_equal_scenes_and_pictures_are_kept_once():
    view, found = View(Speaker("en")), record()
    black = np.zeros((24, 24, 3), np.float32)
    for name in ("a", "b"):
        view.add(name, SCENE, (16, 20), found.paths[:1], rgb=black)
    data = json.loads(view.script())
    assert len(data["scenes"]) == len(data["pictures"]) == 1
    assert [place["picture"] for place in data["places"]] == [1, 1]
