"""Which kernels there are, and which of them are compiled and kept on disk."""

import contextlib
import hashlib
from pathlib import Path
from typing import Any

import numba
from llvmlite.binding import get_host_cpu_name

from elbowroom.jit import kernels_made


def kernels() -> list[Any]:
    """The kernels of our modules imported so far; each is kept on disk once it is compiled."""
    return [kernel for kernel in kernels_made() if kernel.__module__.startswith("elbowroom.")]


def session_kernels() -> list[Any]:
    """Those of `kernels` that a live session may use: not what decodes compressed files or judges experiments."""
    aside = ("elbowroom.formats.", "elbowroom.experiment.")
    return [kernel for kernel in kernels() if not kernel.__module__.startswith(aside)]


def kept_kernels() -> list[Any]:
    """Those of `kernels` which lie on disk for the present source."""
    return [kernel for kernel in kernels() if _has_index(kernel)]


def cache_folders() -> list[str]:
    """Where they are kept."""
    return sorted({str(kernel._cache.cache_path) for kernel in kernels()})


def _has_index(kernel: Any) -> bool:
    return bool(kernel._cache._cache_file._load_index()) and Path(kernel._cache.cache_path).is_dir()


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
    return Path(max(cache_folders())) / "elbowroom-sessions.warm"


def _stamp() -> str:
    """What compiled kernels depend on: the sources as they lie there, the compiler, the processor."""
    package = Path(__file__).parents[1]
    files = sorted(package.rglob("*.py"))
    seen = [f"{file.relative_to(package)} {file.stat().st_mtime_ns} {file.stat().st_size}" for file in files]
    return hashlib.sha256("\n".join([numba.__version__, get_host_cpu_name(), *seen]).encode()).hexdigest()
