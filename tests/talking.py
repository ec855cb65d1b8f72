"""Talks to a viewer as its page does, but says anything."""

import asyncio
import http.client
from concurrent.futures import ThreadPoolExecutor

import aiohttp
import msgpack


def cookie_of(server):
    """The cookie that the printed address earns."""
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=20)
    connection.request("GET", f"/?key={server.key}", headers={"Host": f"127.0.0.1:{server.port}"})
    return connection.getresponse().headers["Set-Cookie"].partition(";")[0]


def talk(server, cookie, *messages, raw=None):
    """Say hello, send calls one after another, and give back every answer."""

    async def conversation():
        address = f"ws://127.0.0.1:{server.port}/ws"
        async with (
            aiohttp.ClientSession() as session,
            session.ws_connect(address, headers={"Cookie": cookie}) as ws,
        ):
            answers = []
            for k, (method, args) in enumerate([("wslink.hello", [{"secret": "wslink-secret"}]), *messages]):
                name = "system:c0:0" if k == 0 else f"rpc:c:{k}"
                call = {"wslink": "1.0", "id": name, "method": method, "args": args, "kwargs": {}}
                await ws.send_bytes(chunk(msgpack.packb(call)))
                answers.append(await answered(ws, name))
            if raw is not None:
                await ws.send_bytes(raw)
            return answers[1:]

    return alone(conversation())


def alone(coroutine):
    """What a coroutine gives, in a thread of its own: the browser of other tests may have left its loop
    running in this one."""
    with ThreadPoolExecutor(1) as thread:
        return thread.submit(asyncio.run, coroutine).result()


def chunk(message):
    """A message as the only chunk of itself: id, offset and full size, then the bytes."""
    return b"".join(number.to_bytes(4, "little") for number in (7, 0, len(message))) + message


async def answered(ws, name):
    while True:
        received = await ws.receive_bytes(timeout=20)
        message = msgpack.unpackb(received[12:], strict_map_key=False)
        if message.get("id") == name:
            return message
