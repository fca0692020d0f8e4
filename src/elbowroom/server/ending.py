"""The end: whatever threads and clients do, a signal ends the program in time."""

import os
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

LATEST = 4.0  # seconds after the first signal

_CODES = {signal.SIGINT: 0, signal.SIGTERM: 128 + signal.SIGTERM}  # Ctrl-C is the way to end the program


def end_at_latest(sig: int, clean: Callable[[], object]) -> None:
    """End the process in a few seconds, after a last call of `clean`, if it has not ended by itself."""

    def end() -> None:
        try:
            clean()
        finally:
            os._exit(_CODES.get(signal.Signals(sig), 1))

    timer = threading.Timer(LATEST, end)
    timer.daemon = True
    timer.start()


@contextmanager
def ended_by_signals(clean: Callable[[], object]) -> Iterator[None]:
    """Have SIGINT raise KeyboardInterrupt and SIGTERM SystemExit here, and the process end even if that is not heard.

    For the main thread; elsewhere this does nothing.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def stop(sig: int, _frame: FrameType | None) -> None:
        end_at_latest(sig, clean)
        if sig == signal.SIGINT:
            raise KeyboardInterrupt
        raise SystemExit(_CODES[signal.Signals(sig)])

    before = {sig: signal.signal(sig, stop) for sig in _CODES}
    try:
        yield
    finally:
        for sig, handler in before.items():
            signal.signal(sig, handler)
