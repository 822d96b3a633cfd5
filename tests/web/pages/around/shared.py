"""Helpers that the tests of this folder share."""

from collections.abc import Callable

from starlette.types import Receive, Scope, Send

from skisnow.web.guard import STATUS


def raising(error: Exception) -> Callable[..., object]:
    def work(*_: object, **__: object) -> object:
        raise error

    return work


async def greeting(scope: Scope, receive: Receive, send: Send) -> None:
    """Answers with the size of the body; with another policy and status where the path asks for them."""
    if scope["type"] == "lifespan":
        await send({"type": "lifespan.startup.complete"})
        return
    if scope["type"] == "websocket":
        await send({"type": "websocket.accept"})
        return
    size, more = 0, True
    while more:
        message = await receive()
        size, more = size + len(message.get("body", b"")), message.get("more_body", False)
        if message["type"] == "http.disconnect":
            await send({"type": "disconnected"})
            return
    headers = [(b"content-security-policy", b"own")] if scope["path"] == "/own" else []
    if scope["path"] == "/status":
        scope[STATUS] = 404
    await send({"type": "http.response.start", "status": 200, "headers": headers})
    await send({"type": "http.response.body", "body": str(size).encode()})
