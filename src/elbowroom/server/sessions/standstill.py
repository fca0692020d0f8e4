"""While nothing moves that one could see, few frames need to be sent. Time is an argument, in seconds."""

import numpy as np

from elbowroom.server.wire.pose_frame import offsets

_GRACE = 1.0  # seconds of standing still after which frames become few
SELDOM = 0.5  # seconds between two frames then
UNSEEN = 1e-3  # metres and parts of a rotation: who breathes moves by less from frame to frame

_AT = offsets()
_MOMENT = slice(_AT["index"], _AT["acknowledged"])  # bytes of the number, the session clock and the simulated time


class Standstill:
    """Watches the frames of a session."""

    def __init__(self) -> None:
        self._before = self._shown = b""
        self._since = self._sent = 0.0

    def worth_sending(self, packed: bytes, now: float, *, restless: bool) -> bool:
        """Whether a frame shows anything new, or the last one was long ago; `restless`: something moves by itself."""
        if restless or _differs(packed, self._before):
            self._since = now
        self._before = packed
        few = now - self._since > _GRACE and now - self._sent < SELDOM
        if few and not _differs(packed, self._shown):
            return False
        self._sent, self._shown = now, packed
        return True


def _differs(frame: bytes, other: bytes) -> bool:
    """Whether one could see a difference between two frames, or they tell of something else."""
    if len(frame) != len(other) or _told(frame) != _told(other):
        return True
    numbers, others = (np.frombuffer(one, "<f4", offset=_AT["x"]) for one in (frame, other))
    with np.errstate(invalid="ignore"):  # without an obstacle the clearance is infinite in both: no number, no more
        return bool((np.abs(numbers - others) > UNSEEN).any())


def _told(frame: bytes) -> bytes:
    return frame[: _MOMENT.start] + frame[_MOMENT.stop : _AT["x"]]
