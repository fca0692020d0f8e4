"""Which kernels there are, and which of them are compiled and kept on disk."""

import contextlib
import json
import os
from pathlib import Path
from typing import Any

import numba
from llvmlite.binding import get_host_cpu_name

from elbowroom.jit import kernels_made
from elbowroom.kernel_cache import cache_folder, digest_of

_PACKAGE = Path(__file__).parents[2]
_ROOMS = ("geometry", "body", "clips", "world", "planning", "control")  # whose kernels a live session may use
_FEW = 10  # files that may have changed and are compiled where they are needed: who develops waits for no more


def kernels() -> list[Any]:
    """The kernels of our modules imported so far; each is kept on disk once it is compiled."""
    return [kernel for kernel in kernels_made() if kernel.__module__.startswith("elbowroom.")]


def session_kernels() -> list[Any]:
    """Those of `kernels` that a live session may use: not what decodes compressed files or judges experiments."""
    return [kernel for kernel in kernels() if kernel.__module__.split(".")[1] in _ROOMS]


def kernels_in_memory() -> int:
    """How many kernels this process has loaded or compiled so far, one for several types of arguments counted for each.

    They stay: who meets for the first time what needs another kernel makes the process larger, once.
    """
    return sum(len(kernel.overloads) for kernel in kernels())


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
    """Whether all that a session needs was compiled, but for a few files that have changed since (`mark_warm`)."""
    try:
        marked = json.loads(_mark_file().read_text("utf-8"))
    except (OSError, ValueError):
        return False
    return is_nearly(marked, _mark())


def is_nearly(marked: Any, present: dict[str, Any]) -> bool:
    """Whether what was marked is what there is now, a few sources aside; the mark may hold anything."""
    if not isinstance(marked, dict) or marked.get("compiler") != present["compiler"]:
        return False
    known = marked.get("sources")
    if not isinstance(known, dict):
        return False
    changed = [file for file, digest in present["sources"].items() if known.get(file) != digest]
    return len(changed) <= _FEW


def mark_warm() -> None:
    """Remember that all that a session needs is compiled and kept."""
    with contextlib.suppress(OSError):
        _mark_file().write_text(json.dumps(_mark()), "utf-8")


def _mark_file() -> Path:
    return (cache_folder(_PACKAGE / "errors.py") or Path(os.devnull)) / "elbowroom-sessions.warm"


def _mark() -> dict[str, Any]:
    """What compiled kernels depend on: the sources that hold any, with what these import; compiler and processor."""
    files = (file for room in _ROOMS for file in sorted((_PACKAGE / room).rglob("*.py")))
    sources = {
        str(file.relative_to(_PACKAGE)): digest_of(file) for file in files if "elbowroom.jit" in file.read_text("utf-8")
    }
    return {"compiler": [numba.__version__, get_host_cpu_name()], "sources": sources}
