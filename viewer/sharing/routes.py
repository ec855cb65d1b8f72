"""Where a page gets the files of FILES: behind the door, as downloads, one at a time."""

import asyncio
import mimetypes

from aiohttp import web

from tracer.settings import TracerError
from viewer.sharing.files import FILES, Moment


def serve_files(web_server, window):
    """Answer /share/NAME of a window's moment."""
    one_at_a_time = asyncio.Lock()

    async def share(request):
        name = request.match_info["name"]
        if name not in FILES:
            raise web.HTTPNotFound
        moment = Moment.of(window.session, window.say)
        async with one_at_a_time:
            try:
                kept_as, data = await asyncio.to_thread(moment.file, name)
            except TracerError as error:
                return web.Response(status=409, text=f"castray: {window.say.error(str(error))}\n")
        kind = mimetypes.guess_type(name)[0] or "application/octet-stream"
        headers = {"Content-Disposition": f'attachment; filename="{kept_as}"'}
        return web.Response(body=data, content_type=kind, headers=headers)

    web_server.app.router.add_get("/share/{name}", share)
