"""Answers of many megabytes, sent no faster than who asked for them takes them.

What is sent at once waits in memory, however large it is; and who lets much wait is ended by the doorman, who cannot
tell a slow line from one that is never read.
"""

from starlette.responses import Response
from starlette.types import Receive, Scope, Send

_PIECE = 64 * 1024  # bytes


class InPieces(Response):
    """Bytes of a known length; before each piece is sent most of what was sent before has been taken."""

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:  # noqa: ARG002
        """Send the head, and the body piece by piece."""
        await send({"type": "http.response.start", "status": self.status_code, "headers": self.raw_headers})
        for first in range(0, len(self.body), _PIECE):
            piece = self.body[first : first + _PIECE]
            await send({"type": "http.response.body", "body": piece, "more_body": True})
        await send({"type": "http.response.body", "body": b"", "more_body": False})
