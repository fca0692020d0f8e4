"""How every hot loop is compiled: one place for the Numba options.

The options and the habits that go with them were measured: unsigned loop indices (`range(np.uint64(n))`),
`error_model="numpy"` and `fastmath` are what lets LLVM vectorise; without them the same loop is ten times slower.

A kernel is compiled once for each combination of argument types, and a literal integer is a type of its own: `int(X)`
makes a plain one of a constant. See "The first start" in docs/architecture.md for what else compilation costs.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
from numba.core import codegen

from elbowroom.kernel_sources import digest_of

Function = TypeVar("Function", bound=Callable[..., Any])

# Without "nnan" and "ninf": kernels may carry infinities as "no obstacle in reach".
_FASTMATH = {"nsz", "contract", "arcp", "afn", "reassoc"}
# No kernel is called from C: without the wrapper for that, all compile in a twelfth less time.
_KEPT: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy", "no_cfunc_wrapper": True}
_LEAF: dict[str, Any] = {"forceinline": True, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}


def _use_whole_vectors() -> None:
    """Let LLVM use 512-bit vectors where the processor has them.

    It prefers half of that on Intel's, as a guess for code with few vector loops; the clearance kernel is 1.3 times
    faster with the whole. Who has set Numba's processor features knows better.
    """
    config: Any = numba.config
    features = cast(Any, codegen).get_host_cpu_features()
    if config.CPU_FEATURES is None and "+avx512f" in features:
        config.CPU_FEATURES = f"{features},-prefer-256-bit"


_use_whole_vectors()


def kernel(function: Function) -> Function:
    """Compile `function` for the hot path: cached on disk, without the GIL, NumPy division rules."""
    return cast(Function, _kept(numba.njit(fastmath=_FASTMATH, **_KEPT)(function)))


def exact_kernel(function: Function) -> Function:
    """Compile `function` with strict IEEE arithmetic: for searches and state that must repeat bit for bit."""
    return cast(Function, _kept(numba.njit(**_KEPT)(function)))


def _kept(dispatcher: Any) -> Any:
    """Have what is kept on disk forgotten when any source that was compiled into it has changed."""
    file = getattr(dispatcher._cache, "_cache_file", None)
    if file is not None:
        file._source_stamp = file._source_stamp, digest_of(Path(dispatcher.py_func.__code__.co_filename))
    return dispatcher


def inlined(function: Function) -> Function:
    """Compile a helper that is inlined into kernels of its own file, by Numba: for what calls kernels, in one place."""
    return cast(Function, numba.njit(fastmath=_FASTMATH, error_model="numpy", inline="always")(function))


def leaf(function: Function) -> Function:
    """Compile a helper that LLVM inlines into kernels of its own file: for what is small and used in many places.

    It calls no kernel, and calculates as the first kernel that calls it does: kernels that share one are of one kind.
    It cannot be called from Python.
    """
    return cast(Function, numba.njit(**_LEAF)(function))
