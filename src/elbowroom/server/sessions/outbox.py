"""What waits to be sent to one client: a slow client gets fewer frames, never older ones."""

import asyncio
from collections import deque

from starlette.websockets import WebSocket

from elbowroom.server.schema.progress import Plan, Pushed, Status
from elbowroom.server.wire.codec import encode
from elbowroom.server.wire.messages import ServerMessage

MAX_WAITING = 256  # messages; a client that lets so many pile up is given up
_REPLACED = (Status, Plan, Pushed)  # of these only the newest matters: of what is pushed, of each thing


class SlowClientError(Exception):
    """The client does not read what it is sent."""


class Outbox:
    """Messages in order, and the newest pose frame."""

    def __init__(self) -> None:
        self._messages: deque[ServerMessage | str] = deque()
        self._frame: bytes | None = None
        self._wake = asyncio.Event()
        self.dropped = 0  # frames replaced before they were sent

    def put(self, message: ServerMessage | str) -> None:
        """Send a message, or one that is encoded already, in order; raises `SlowClientError` if too many wait."""
        if isinstance(message, _REPLACED):
            self._messages = deque(m for m in self._messages if not _replaces(message, m))
        if len(self._messages) >= MAX_WAITING:
            raise SlowClientError
        self._messages.append(message)
        self._wake.set()

    def put_frame(self, frame: bytes) -> None:
        """Send a frame after the messages that wait, in place of a frame that waits."""
        self.dropped += self._frame is not None
        self._frame = frame
        self._wake.set()

    def drop_frame(self) -> None:
        """Forget the frame that waits: what comes next makes it out of date."""
        self._frame = None

    async def send_to(self, socket: WebSocket) -> None:
        """Send for ever, as fast as the client reads."""
        while True:
            await self._wake.wait()
            self._wake.clear()
            while self._messages:
                message = self._messages.popleft()
                await socket.send_text(message if isinstance(message, str) else encode(message))
            if self._frame is not None:
                frame, self._frame = self._frame, None
                await socket.send_bytes(frame)


def _replaces(message: ServerMessage, older: ServerMessage | str) -> bool:
    if isinstance(message, Pushed) and isinstance(older, Pushed) and message.obstacle != older.obstacle:
        return False
    return type(message) is type(older)
