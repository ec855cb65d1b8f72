"""Where a page brings files to: behind the door, one at a time, no larger than said."""

import asyncio
from dataclasses import replace

from aiohttp import web

from tracer.settings import Settings, TracerError
from viewer.link import Link
from viewer.opening.uploads import check_size, named, opened


def serve_opening(web_server, window, calls):
    """Take what is sent to /open?name=NAME and show it. calls: {name: function} of the page."""
    one_at_a_time = asyncio.Lock()

    async def taken(request):
        try:
            name = named(request.query.get("name", ""))
            check_size(name, request.content_length or 0)
            async with one_at_a_time:
                data = await _body(request, name)
                upload = await asyncio.to_thread(opened, name, data, window.session.scene)
                with window.state:
                    _show(upload, window, calls)
        except TracerError as error:
            return web.Response(status=422, text=window.say.error(str(error)))
        return web.Response(status=204)

    web_server.app.router.add_post("/open", taken)


async def _body(request, name):
    """All that is sent. Raises TracerError as soon as it is too much."""
    data = bytearray()
    async for chunk in request.content.iter_chunked(1 << 16):
        data += chunk
        check_size(name, len(data))
    return bytes(data)


def _show(upload, window, calls):
    """Turn the page to what was opened."""
    if upload.scene is not None:
        window.session.uploaded[upload.scene.name] = upload.scene
        window.open(Link(upload.scene.name, Settings()))
    elif upload.given is not None:
        window.give(upload.given)
        show_findings(window)
    else:
        _compare(upload.rival, window, calls)


def _compare(rival, window, calls):
    """Compare the picture of the scene, at the other one's size, with it."""
    session = window.session
    height, width = rival.picture.rgb.shape[:2]
    if (session.settings.width, session.settings.height) != (width, height):
        window.alter(session.scene, replace(session.settings, width=width, height=height))
    session.rivals[rival.name] = rival
    calls["compare"](rival.name)
    window.state.tab = "compare"
    window.look("compare")


def show_findings(window):
    """Open the doctor's tab where it has found something in what is given."""
    if window.session.given.chart.diagnosis.findings:
        window.state.tab = "doctor"
        window.look("doctor")
