"""How many messages a client may send."""

from dataclasses import dataclass


@dataclass
class TokenBucket:
    """Allows `rate` events a second on average and `burst` at once; time is an argument."""

    rate: float  # events per second
    burst: float  # events

    def __post_init__(self) -> None:
        self._tokens = self.burst
        self._last: float | None = None

    def allows(self, now: float, events: int = 1) -> bool:
        """Whether so many more events at time `now` (seconds, never decreasing) stay within the limit."""
        elapsed = 0.0 if self._last is None else max(now - self._last, 0.0)
        self._last = now
        self._tokens = min(self._tokens + elapsed * self.rate, self.burst)
        if self._tokens < events:
            return False
        self._tokens -= events
        return True
