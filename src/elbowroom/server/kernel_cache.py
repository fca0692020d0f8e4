"""Which kernels there are, and which of them are compiled and kept on disk."""

import gc
from pathlib import Path
from typing import Any

from numba.core.caching import NullCache
from numba.core.dispatcher import Dispatcher


def kernels() -> list[Any]:
    """The kernels of our modules imported so far that are kept on disk once they are compiled."""
    found: list[Any] = [thing for thing in gc.get_objects() if isinstance(thing, Dispatcher)]
    ours = (kernel for kernel in found if kernel.__module__.startswith("elbowroom."))
    return [kernel for kernel in ours if not isinstance(kernel._cache, NullCache)]


def kept_kernels() -> list[Any]:
    """Those of `kernels` which lie on disk for the present source."""
    return [kernel for kernel in kernels() if _has_index(kernel)]


def cache_folders() -> list[str]:
    """Where they are kept."""
    return sorted({str(kernel._cache.cache_path) for kernel in kernels()})


def _has_index(kernel: Any) -> bool:
    return bool(kernel._cache._cache_file._load_index()) and Path(kernel._cache.cache_path).is_dir()
