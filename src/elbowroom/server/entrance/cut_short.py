"""Requests that are still worked on when the server ends: their clients are told so."""

import asyncio

from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

ABOUT_TO_END = "this server is about to end; try again in a moment"


class CutShort:
    """ASGI middleware: a request that is cancelled, which only the end of the server does, is answered with 503."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on."""
        begun = False

        async def sent(message: Message) -> None:
            nonlocal begun
            begun = True
            await send(message)

        try:
            await self._app(scope, receive, sent)
        except asyncio.CancelledError:
            if scope["type"] != "http":
                raise
            if not begun:
                await JSONResponse({"error": ABOUT_TO_END}, 503, headers={"connection": "close"})(scope, receive, send)
