"""How every hot loop is compiled: one place for the Numba options, all of them public.

There are three kinds. A `kernel` computes with fast mathematics: for batches of distances. An `exact_kernel` keeps to
IEEE arithmetic: for searches and state that must repeat bit for bit. A `helper` is inlined into the kernels that call
it and computes as they do. Kernels of both kinds may call each other and be called from Python. A kernel is compiled
with all that it calls: what one kernel alone calls, in one place, is a helper, or it is compiled twice.

To take arguments from Python is a function of its own, and a third of what compiling a kernel costs. Those that only
kernels call go without it, as an `inner_kernel` or an `inner_exact_kernel`.

While a kernel computes, other threads may use the interpreter, and it waits up to a millisecond to have it back: long
for who calls thirty of them in a frame. What takes a frame microseconds keeps it: `brief_kernel`, `brief_exact_kernel`.

The options and the habits that go with them were measured: unsigned loop indices (`range(np.uint64(n))`),
`error_model="numpy"` and `fastmath` are what lets LLVM vectorise; without them the same loop is ten times slower.

Where there is no option, private parts of Numba are used, in three places: a kernel's cache is wrapped here, and its
call refused where it has no entrance; `kernel_library.py` and `kernel_bitcode.py` say how compiled code is linked and
kept. So `pyproject.toml` has an upper bound on its version.
"""

import os
import warnings
from collections.abc import Callable
from functools import cache
from pathlib import Path
from types import FunctionType
from typing import Any, TypeVar, cast, overload

import numba
import numpy as np
from llvmlite.binding import get_host_cpu_features

from elbowroom.kept_kernels import KeptKernel, name_of
from elbowroom.kernel_cache import cache_folder, cached_by_sources
from elbowroom.kernel_library import KernelCompiler

Function = TypeVar("Function", bound=Callable[..., Any])

# Without "nnan" and "ninf": kernels may carry infinities as "no obstacle in reach".
_FASTMATH = {"nsz", "contract", "arcp", "afn", "reassoc"}
# No kernel is called from C: without the wrapper for that, all compile in a twelfth less time.
_OPTIONS: dict[str, Any] = {
    "nogil": True,
    "error_model": "numpy",
    "no_cfunc_wrapper": True,
    "pipeline_class": KernelCompiler,
}
_kernels: list[Any] = []  # all that were made: they last as long as their modules


def _use_whole_vectors() -> None:
    """Let LLVM use 512-bit vectors where the processor has them.

    It prefers half of that on Intel's, as a guess for code with few vector loops; the clearance kernel is 1.3 times
    faster with the whole. Who has set Numba's processor features knows better.
    """
    config: Any = numba.config
    if config.CPU_FEATURES is None and "+avx512f" in (features := get_host_cpu_features().flatten()):
        config.CPU_FEATURES = f"{features},-prefer-256-bit"


_use_whole_vectors()


def kernel(function: Function) -> Function:
    """Compile `function` with fast mathematics: cached on disk, without the GIL, NumPy's rules of division."""
    return _compiled(function, fastmath=_FASTMATH)


def exact_kernel(function: Function) -> Function:
    """Compile `function` with strict IEEE arithmetic: for searches and state that must repeat bit for bit."""
    return _compiled(function, fastmath=False)


def brief_kernel(function: Function) -> Function:
    """Compile a `kernel` that keeps the interpreter: for what a frame computes, microseconds at a time."""
    return _compiled(function, fastmath=_FASTMATH, nogil=False)


def brief_exact_kernel(function: Function) -> Function:
    """Compile an `exact_kernel` that keeps the interpreter."""
    return _compiled(function, fastmath=False, nogil=False)


def inner_kernel(function: Function) -> Function:
    """Compile a `kernel` that other kernels alone call."""
    return _without_entrance(_compiled(function, fastmath=_FASTMATH, no_cpython_wrapper=True))


def inner_exact_kernel(function: Function) -> Function:
    """Compile an `exact_kernel` that other kernels alone call."""
    return _without_entrance(_compiled(function, fastmath=False, no_cpython_wrapper=True))


def helper(function: Function) -> Function:
    """Compile a helper that is inlined into the kernels that call it."""
    return cast(Function, numba.njit(error_model="numpy", inline="always")(function))


@overload
def plain(number: bool) -> bool: ...


@overload
def plain(number: int) -> int: ...


def plain(number: int) -> int:
    """A whole number, or a truth value, that kernels take like any other.

    To Numba every literal of these is a type of its own, and a kernel that is called with one is compiled once more for
    it. Constants that are handed to kernels are made plain where they are defined.
    """
    return cast(int, np.bool_(number) if isinstance(number, bool) else np.int64(number))


def kernels_made() -> list[Any]:
    """All kernels of the modules imported so far, in that order: Numba's dispatchers."""
    return list(_kernels)


def _compiled(function: Function, **options: Any) -> Function:
    code = function.__code__
    folder = cache_folder(Path(code.co_filename))
    with cached_by_sources():
        dispatcher = numba.njit(cache=folder is not None, **(_OPTIONS | options))(function)
    if folder is not None and hasattr(dispatcher, "_cache"):  # a plain function, where Numba is told not to compile
        name = name_of(Path(code.co_filename), function.__qualname__, code.co_firstlineno)
        dispatcher._cache = KeptKernel(dispatcher._cache, folder, name)
    elif folder is None:
        _tell_that_none_are_kept()
    _kernels.append(dispatcher)
    return cast(Function, dispatcher)


def _without_entrance(function: Function) -> Function:
    """Refuse calls from Python: there is no code that would take them, and Numba would not ask."""
    dispatcher: Any = function
    kind: Any = type(function)
    if kind is not FunctionType:  # as it is where Numba is told not to compile
        dispatcher.__class__ = _refusing(kind)
    return function


@cache
def _refusing(dispatchers: type) -> type:
    def refuse(kernel: Any, *_: object, **__: object) -> None:
        raise TypeError(f"{kernel.__name__} is called by other kernels alone: make it a `kernel` or an `exact_kernel`")

    return type(dispatchers.__name__, (dispatchers,), {"__call__": refuse})


@cache
def _tell_that_none_are_kept() -> None:
    """Once; a command has told it already, and has set the variable to no folder at all."""
    if os.environ.get("NUMBA_CACHE_DIR") != os.devnull:
        text = "no folder for compiled kernels can be written to: every start compiles them anew, which takes minutes"
        warnings.warn(f"{text}; set NUMBA_CACHE_DIR", RuntimeWarning, stacklevel=4)
