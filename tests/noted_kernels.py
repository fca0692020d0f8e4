"""Which kernels are called from Python, and with what."""

from collections.abc import Callable
from typing import Any

import pytest

from elbowroom.jit import kernels_made


def note_kernels(monkeypatch: pytest.MonkeyPatch, note: Callable[[Any, tuple[Any, ...]], None]) -> None:
    """Have each call of one of our kernels noted, with its arguments, before it is done."""

    def noting(dispatchers: type) -> type:
        def call(kernel: Any, *arguments: Any) -> Any:
            note(kernel, arguments)
            return dispatchers.__call__(kernel, *arguments)

        return type(dispatchers.__name__, (dispatchers,), {"__call__": call})

    for kernel in kernels_made():
        if kernel.__module__.startswith("elbowroom.") and not kernel.targetoptions.get("no_cpython_wrapper"):
            monkeypatch.setattr(kernel, "__class__", noting(type(kernel)))
