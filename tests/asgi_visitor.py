"""A request that an application gets over no network, whose sender sends and leaves when a test says so."""

import asyncio
import json
from typing import Any

from starlette.types import ASGIApp, Message

LONG = 60.0  # seconds: only a hang lasts longer


class Visitor:
    """One request, being answered; to be made in an event loop."""

    def __init__(self, app: ASGIApp, method: str, path: str, machine: str = "127.0.0.1", query: str = "") -> None:
        self.heard = 0  # messages of the sender that were taken
        self.status = 0  # of the answer, once there is one
        self._said, self._body = asyncio.Queue[Message](), b""
        headers = [(b"host", b"127.0.0.1:8765")]
        asked = {"type": "http", "method": method, "path": path, "query_string": query.encode(), "headers": headers}
        self._task = asyncio.ensure_future(app(asked | {"client": (machine, 50000)}, self._receive, self._send))

    def sends(self, body: bytes, *, last: bool = False) -> None:
        """Send a piece of the body."""
        self._said.put_nowait({"type": "http.request", "body": body, "more_body": not last})

    def leaves(self) -> None:
        """End the connection."""
        self._said.put_nowait({"type": "http.disconnect"})

    @property
    def answered(self) -> bool:
        """Whether all of the answer is there."""
        return self._task.done()

    async def answer(self) -> tuple[int, Any]:
        """The status of the answer and the JSON in it."""
        await asyncio.wait_for(self._task, LONG)
        return self.status, json.loads(self._body or "null")

    async def _receive(self) -> Message:
        message = await self._said.get()
        self.heard += 1
        return message

    async def _send(self, message: Message) -> None:
        self.status = message.get("status", self.status)
        self._body += message.get("body", b"")
