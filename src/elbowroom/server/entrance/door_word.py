"""A server behind a door: it answers to the door alone, which says for whom it asks."""

import hmac

from starlette.datastructures import Headers
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Receive, Scope, Send

FOR, WORD = b"x-forwarded-for", b"x-elbowroom-door"


class BehindDoor:
    """ASGI middleware: refuses who does not know the door's word, and takes from the door who the client is."""

    def __init__(self, app: ASGIApp, word: str) -> None:
        self._app, self._word = app, word.encode()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, or answer 403."""
        if scope["type"] in ("http", "websocket"):
            headers = Headers(scope=scope)
            if not hmac.compare_digest(headers.get(WORD.decode(), "").encode(), self._word):
                await _refuse(scope, receive, send)
                return
            scope = {**scope, "client": (headers.get(FOR.decode(), ""), 0)}
        await self._app(scope, receive, send)


async def _refuse(scope: Scope, receive: Receive, send: Send) -> None:
    if scope["type"] == "websocket":
        await receive()
        await send({"type": "websocket.close", "code": 1008, "reason": "come through the door"})
    else:
        await PlainTextResponse("come through the door\n", 403)(scope, receive, send)
