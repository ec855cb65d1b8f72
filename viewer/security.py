"""Who may talk to the viewer: the browser that was given the key, from this machine, under this address.

trame itself checks neither Origin nor Host, and the key its clients use is public. So every request passes
`Door` first, and every remote call passes `restrict`.
"""

import hmac
import inspect
import re
import secrets
import sys
from itertools import count
from pathlib import Path

from aiohttp import web

from tracer.settings import TracerError

STATIC = Path(__file__).parent / "static"
REFUSED = "castray: this viewer opens only by the address that was printed when it started.\n"
NOBODY = "'none'"
HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cache-Control": "no-store",
}
# what the page's own code calls; everything else that trame and vtk export is closed
CALLS = (
    "trame.state.get",
    "trame.state.update",
    "trame.trigger",
    "trame.error.client",
    "trame.lifecycle.update",
    "viewport.geometry.array.get",
)


MOST_TOLD, LONGEST_TOLD = 100, 300  # lines on the terminal about what pages ask, characters of each
_TOLD = count()


class Door:
    """The middleware in front of every request, WebSocket included; behind it, `page` is the answer to /.

    framed: whether pages of this machine may show it in a frame; they may ask by the key whether it is there.
    """

    def __init__(self, page, framed=False):
        self.key, self.page, self.framed = secrets.token_urlsafe(24), page, framed

    @web.middleware
    async def middleware(self, request, handler):
        """Refuse strangers; otherwise answer, with the headers that keep the page to itself."""
        port = request.transport.get_extra_info("sockname")[1]
        if not _from_here(request, port):
            return web.Response(status=403, text=REFUSED, headers=HEADERS)
        opens = self._fits(request.query.get("key", ""))
        if opens and self.framed and request.path == "/alive":
            return web.Response(
                status=204, headers=HEADERS | {"Cross-Origin-Resource-Policy": "cross-origin"}
            )
        opened = opens and request.path == "/"
        if not (opened or self._fits(request.cookies.get(f"castray-{port}", ""))):
            return web.Response(status=403, text=REFUSED, headers=HEADERS)
        response = await self._answer(request, handler)
        if not response.prepared:
            response.headers.update(HEADERS)
            response.headers["Content-Security-Policy"] = _policy(port, self.framed)
            if opened:
                # the answer is the page itself, not a redirect: a browser that came by a foreign link
                # would not send a strict cookie along with the redirected request
                response.set_cookie(f"castray-{port}", self.key, httponly=True, samesite="Strict", path="/")
        return response

    async def _answer(self, request, handler):
        if request.path == "/":
            return web.Response(text=self.page, content_type="text/html")
        try:
            return await handler(request)
        except web.HTTPException as answer:
            return web.Response(status=answer.status, text=f"{answer.reason}\n")
        except (ConnectionError, TimeoutError):
            raise
        except Exception as error:
            _tell(f"{request.path}: {error!r}")
            return web.Response(status=500, text="castray: something went wrong\n")

    def _fits(self, key):
        return hmac.compare_digest(key.encode(), self.key.encode())


def _from_here(request, port):
    hosts = [f"127.0.0.1:{port}", f"localhost:{port}"]
    origin = request.headers.get("Origin")
    return request.headers.get("Host") in hosts and (
        origin is None or origin in [f"http://{h}" for h in hosts]
    )


def _policy(port, framed):
    sockets = f"ws://127.0.0.1:{port} ws://localhost:{port}"
    return "; ".join(
        (
            "default-src 'none'",
            "script-src 'self' 'unsafe-eval'",  # Vue compiles its templates in the page
            "style-src 'self' 'unsafe-inline'",
            "img-src 'self' data: blob:",
            "font-src 'self'",
            f"connect-src 'self' {sockets}",
            "base-uri 'none'",
            "form-action 'none'",
            f"frame-ancestors {'http://127.0.0.1:* http://localhost:*' if framed else NOBODY}",
        )
    )


def files(ending):
    """The page's own scripts or style sheets, the one that the others lean on first."""
    names = (file.name for file in STATIC.glob(f"*{ending}"))
    return sorted(names, key=lambda name: (not name.startswith("castray."), name))


def page(title):
    """trame's page without its inline script, which the policy forbids, and with ours first."""
    from trame_client.module.vue3 import www

    original = (Path(www) / "index.html").read_text(encoding="utf-8")
    scripts = re.findall(r'<script type="module"[^>]* src="([^"]+)"', original)
    styles = re.findall(r'<link rel="stylesheet"[^>]* href="([^"]+)"', original)
    lines = [
        '<!doctype html><html lang="en" data-app-name="trame"><head><meta charset="UTF-8">',
        f"<title>{title}</title>",
        '<meta name="viewport" content="width=device-width,initial-scale=1">',
        '<link rel="icon" href="castray/icon.svg">',
        '<script src="castray/boot.js"></script>',
        '<script src="vue.global.js"></script>',
        *(f'<script type="module" src="{src}"></script>' for src in scripts),
        *(f'<link rel="stylesheet" href="{href}">' for href in styles),
        *(f'<link rel="stylesheet" href="castray/{name}">' for name in files(".css")),
        '</head><body><div id="app"></div></body></html>',
    ]
    return "\n".join(lines)


def restrict(web_server, triggers, before_state):
    """Leave a page only the calls it needs, checked, and answer without tracebacks.

    triggers: {name: function}. before_state is called before a page is told the whole state.
    """

    def whole_state(protocol):
        before_state()
        return protocol.get_server_state()

    async def trigger(protocol, name, args=(), kwargs=None):
        if name not in triggers or not isinstance(args, (list, tuple)):
            return None
        with protocol.server.state:
            answer = triggers[name](*args)
            return await answer if inspect.isawaitable(answer) else answer

    checked = {
        "trame.state.get": whole_state,
        "trame.state.update": lambda protocol, *_: None,  # a page changes the state by triggers only
        "trame.trigger": trigger,
        "trame.error.client": lambda protocol, message="", *_: _tell(f"the page reports: {message}"),
        "trame.lifecycle.update": lambda protocol, *_: None,
    }
    for handler in web_server._ws_handlers:
        handler.serverProtocol.validateToken = _anyone  # the door has seen the key
        calls = handler.functionMap
        allowed = {uri: (calls[uri][0], _quiet(checked.get(uri, calls[uri][1]))) for uri in CALLS}
        calls.clear()
        calls.update(allowed)


async def _anyone(token, client_id):
    return True


def _tell(text):
    """One line on the terminal; after many of them none, or who reads nothing of it would stop the server."""
    number = next(_TOLD)
    if number < MOST_TOLD:
        print(f"castray: {' '.join(text.split())[:LONGEST_TOLD]}", file=sys.stderr)
    elif number == MOST_TOLD:
        print("castray: more of this kind is not told", file=sys.stderr)


def _quiet(function):
    """The same call, but what goes wrong is told here in one line and to the page not at all."""

    async def call(*args, **kwargs):
        try:
            answer = function(*args, **kwargs)
            return await answer if inspect.isawaitable(answer) else answer
        except (TracerError, TypeError, ValueError, KeyError, IndexError, AttributeError) as error:
            _tell(f"refused: {type(error).__name__}: {error}")
            return None

    return call
