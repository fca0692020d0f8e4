"""Which kernels there are, and which of them are compiled and kept on disk."""

import contextlib
import hashlib
import os
from pathlib import Path
from typing import Any

import numba
from llvmlite.binding import get_host_cpu_name

from elbowroom.jit import kernels_made
from elbowroom.kernel_cache import cache_folder

_PACKAGE = Path(__file__).parents[1]
_ROOMS = ("geometry", "body", "clips", "world", "planning", "control")  # whose kernels a live session may use


def kernels() -> list[Any]:
    """The kernels of our modules imported so far; each is kept on disk once it is compiled."""
    return [kernel for kernel in kernels_made() if kernel.__module__.startswith("elbowroom.")]


def session_kernels() -> list[Any]:
    """Those of `kernels` that a live session may use: not what decodes compressed files or judges experiments."""
    return [kernel for kernel in kernels() if kernel.__module__.split(".")[1] in _ROOMS]


def kept_kernels() -> list[Any]:
    """Those of `kernels` that lie on disk, for some source."""
    return [kernel for kernel in kernels() if _is_kept(kernel)]


def cache_folders() -> list[str]:
    """Where they are kept; none if there is no place to write to."""
    return sorted({str(folder) for kernel in kernels() if (folder := _folder(kernel)) is not None})


def _folder(kernel: Any) -> Path | None:
    return cache_folder(Path(kernel.py_func.__code__.co_filename))


def _is_kept(kernel: Any) -> bool:
    """Whether Numba has written the index of a kernel: FILE.FUNCTION-LINE.pyVERSION.nbi."""
    code, folder = kernel.py_func.__code__, _folder(kernel)
    name = f"{Path(code.co_filename).stem}.{kernel.py_func.__qualname__}-{code.co_firstlineno}.py*.nbi"
    return folder is not None and any(folder.glob(name))


def is_warm() -> bool:
    """Whether `mark_warm` was called for the present sources and compiler."""
    try:
        return _stamp_file().read_text("ascii") == _stamp()
    except OSError:
        return False


def mark_warm() -> None:
    """Remember that all that a session needs is compiled and kept."""
    with contextlib.suppress(OSError):
        _stamp_file().write_text(_stamp(), "ascii")


def _stamp_file() -> Path:
    return (cache_folder(_PACKAGE / "jit.py") or Path(os.devnull)) / "elbowroom-sessions.warm"


def _stamp() -> str:
    """What compiled kernels depend on: the sources of the rooms that hold any, the compiler, the processor."""
    files = sorted(file for room in _ROOMS for file in (_PACKAGE / room).rglob("*.py"))
    seen = [f"{file.relative_to(_PACKAGE)} {hashlib.sha256(file.read_bytes()).hexdigest()}" for file in files]
    return hashlib.sha256("\n".join([numba.__version__, get_host_cpu_name(), *seen]).encode()).hexdigest()
