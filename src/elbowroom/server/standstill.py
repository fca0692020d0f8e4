"""While nothing moves, few frames need to be sent. Time is an argument, in seconds."""

from elbowroom.server.pose_frame import offsets

_GRACE = 1.0  # seconds of standing still after which frames become few
SELDOM = 0.5  # seconds between two frames then

_AT = offsets()
_MOMENT = slice(_AT["index"], _AT["acknowledged"])  # bytes of the number, the session clock and the simulated time


class Standstill:
    """Watches the frames of a session."""

    def __init__(self) -> None:
        self._picture = b""
        self._since = self._sent = 0.0

    def worth_sending(self, packed: bytes, now: float, *, restless: bool) -> bool:
        """Whether a frame shows anything new, or the last one was long ago; `restless`: something moves by itself."""
        picture = packed[: _MOMENT.start] + packed[_MOMENT.stop :]
        if restless or picture != self._picture:
            self._picture, self._since = picture, now
        if now - self._since > _GRACE and now - self._sent < SELDOM:
            return False
        self._sent = now
        return True
