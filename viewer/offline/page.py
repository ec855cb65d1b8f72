"""A whole HTML document, and one that shows a pixel's paths."""

import base64
from html import escape
from pathlib import Path

from viewer.numerals import luminance
from viewer.offline.view import View
from viewer.security import STATIC

HERE = Path(__file__).parent
BEGIN = """castrayView(document.querySelector(".castray-3d"),
  JSON.parse(document.getElementById("paths").textContent));"""
MOST_PATHS = 64  # more are only fog


def document(title, body, language, styles="", scripts=""):
    """A page that asks nobody for anything. title: plain text; the rest as it is to stand there."""
    return (
        f'<!doctype html>\n<html lang="{language}"><head><meta charset="utf-8">\n'
        f"<title>{escape(title)}</title>\n"
        '<meta name="viewport" content="width=device-width,initial-scale=1">\n'
        f'<link rel="icon" href="{svg_icon()}">\n<style>{styles}</style></head>\n'
        f"<body>{body}\n<script>{scripts}</script></body></html>\n"
    )


def furniture():
    """(styles, scripts) of the 3D view."""
    return tuple((HERE / name).read_text(encoding="utf-8") for name in ("view.css", "view.js"))


def svg_icon():
    """castray's mark as an address."""
    mark = base64.b64encode((STATIC / "icon.svg").read_bytes()).decode("ascii")
    return f"data:image/svg+xml;base64,{mark}"


def page(scene, record, cursor, say, rgb=None, over=None):
    """One pixel's paths as a document, opened where the cursor stands. record: of `tracer.inspect`; over: the
    Hemisphere that is shown there."""
    title = say("offline.title", scene=scene.name, x=cursor.x, y=cursor.y)
    styles, scripts = furniture()
    body = (
        f'<main class="alone"><h1>{escape(title)}</h1>{figure(scene, record, cursor, say, rgb, over)}'
        f"<p>{escape(say('offline.help'))}</p></main>"
    )
    return document(title, body, say.language, styles, f"{scripts}\n{BEGIN}")


def figure(scene, record, cursor, say, rgb=None, over=None):
    """The same as a part of a page's body: one of them, whose page has the furniture and ends with BEGIN."""
    paths = {k: record.paths[k] for k in _worth_drawing(record, cursor.path)}
    view = View(say)
    pixel = (cursor.x, cursor.y)
    view.add("", scene, pixel, paths.values(), list(paths).index(cursor.path), cursor.event, rgb, over)
    return (
        f'<div class="castray-3d"></div><script type="application/json" id="paths">{view.script()}</script>'
    )


def _worth_drawing(record, chosen):
    """Which paths are told: the chosen one and those that carry most, in their order."""
    most = sorted(range(len(record.paths)), key=lambda k: -luminance(record.paths[k].radiance))
    return sorted({chosen, *most[: MOST_PATHS - 1]})
