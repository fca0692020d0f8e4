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
from numba.core.compiler import Compiler
from numba.core.registry import CPUDispatcher

from elbowroom.kernel_libraries import KernelCache, LinkedCache, LinkedLibrary, entry_for_kernels
from elbowroom.kernel_sources import digest_of

Function = TypeVar("Function", bound=Callable[..., Any])

# Without "nnan" and "ninf": kernels may carry infinities as "no obstacle in reach".
_FASTMATH = {"nsz", "contract", "arcp", "afn", "reassoc"}
# No kernel is called from C: without the wrapper for that, all compile in a twelfth less time.
_KEPT: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy", "no_cfunc_wrapper": True}
_LEAF: dict[str, Any] = {"nogil": True, "no_cfunc_wrapper": True, "_nrt": True}
_COUNTING: dict[str, Any] = {"_nrt": True} | _KEPT  # references to arrays; said, since callers would decide otherwise
_LEAN: dict[str, Any] = {"_nrt": False} | _KEPT
_kernels: list[Any] = []  # all that were made: they last as long as their modules


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


class _InnerCompiler(Compiler):
    """Makes no wrapper for Python, and no machine code.

    That is said here and not among the options: Numba compiles what a kernel uses of NumPy anew for other options.
    """

    def define_pipelines(self) -> Any:
        """Numba's own passes, after a word about the result."""
        self.state.flags.no_cpython_wrapper = True
        self.state.flags.no_compile = True
        self.state.library = LinkedLibrary(self.state.targetctx.codegen(), self.state.func_id.func_qualname)
        return super().define_pipelines()


class _LeafCompiler(_InnerCompiler):
    """Has LLVM inline the result."""

    def define_pipelines(self) -> Any:
        """Numba's own passes, after a word about the result."""
        self.state.flags.forceinline = True
        return super().define_pipelines()


class _InnerDispatcher(CPUDispatcher):
    """A compiled function without a wrapper for Python, which by itself would end the process if Python called it."""

    def add_overload(self, cres: Any) -> None:
        """Keep what was compiled for kernels to call, and not where the interpreter looks."""
        if cres.entry_point is None:
            cres = cres._replace(entry_point=entry_for_kernels())
            self.targetctx.insert_user_function(cres.entry_point, cres.fndesc, [cres.library])
        self.overloads[tuple(cres.signature.args)] = cres

    def _compile_for_args(self, *args: Any, **kws: Any) -> Any:
        del args, kws
        name = f"{self.__module__}.{self.py_func.__name__}"
        raise TypeError(f"{name} is called by kernels only; for Python to call it, make it a kernel or exact_kernel")


def kernel(function: Function) -> Function:
    """Compile `function` for the hot path: cached on disk, without the GIL, NumPy division rules."""
    return cast(Function, _kept(numba.njit(fastmath=_FASTMATH, **_COUNTING)(function)))


def exact_kernel(function: Function) -> Function:
    """Compile `function` with strict IEEE arithmetic: for searches and state that must repeat bit for bit."""
    return cast(Function, _kept(numba.njit(**_COUNTING)(function)))


def inner_kernel(function: Function) -> Function:
    """Compile as `kernel` does what only kernels call, without the wrapper for Python."""
    compiled = numba.njit(fastmath=_FASTMATH, pipeline_class=_InnerCompiler, **_COUNTING)(function)
    return cast(Function, _inner(_kept(compiled)))


def exact_inner_kernel(function: Function) -> Function:
    """Compile as `exact_kernel` does what only kernels call, without the wrapper for Python."""
    return cast(Function, _inner(_kept(numba.njit(pipeline_class=_InnerCompiler, **_COUNTING)(function))))


def lean_kernel(function: Function) -> Function:
    """Compile as `inner_kernel` what makes no array and returns none: without counting references.

    To hand a tuple of arrays on, or to take one out, costs two atomic operations for each array in it where references
    are counted; a function that is handed a limb and its tables spends more time on that than on a dozen postures.
    What it needs to work on it is given. It must call no kernel that returns arrays: nobody would free them.
    """
    compiled = numba.njit(fastmath=_FASTMATH, pipeline_class=_InnerCompiler, **_LEAN)(function)
    return cast(Function, _inner(_kept(compiled)))


def exact_lean_kernel(function: Function) -> Function:
    """Compile as `exact_inner_kernel` what makes no array and returns none; see `lean_kernel`."""
    compiled = numba.njit(pipeline_class=_InnerCompiler, **_LEAN)(function)
    return cast(Function, _inner(_kept(compiled)))


def _inner(dispatcher: Any) -> Any:
    """Have a call from Python refused with an error."""
    dispatcher.__class__ = _InnerDispatcher
    _keep_as(LinkedCache, dispatcher)
    return dispatcher


def kernels_made() -> list[Any]:
    """All kernels of the modules imported so far, in that order: Numba's dispatchers."""
    return list(_kernels)


def _kept(dispatcher: Any) -> Any:
    """Have what is kept on disk forgotten when any source that was compiled into it has changed."""
    _kernels.append(dispatcher)
    _keep_as(KernelCache, dispatcher)
    return forgotten_with(Path(dispatcher.py_func.__code__.co_filename), dispatcher)


def _keep_as(cache: Any, dispatcher: Any) -> None:
    """Have what a kernel keeps on disk written and read by a class of ours; a leaf keeps nothing."""
    made = getattr(dispatcher._cache, "_impl", None)
    if made is not None:
        made.__class__ = cache


def forgotten_with(source: Path, dispatcher: Any) -> Any:
    """Have what a kernel keeps on disk forgotten when a source, or what it imports, has changed.

    It is not even read then: it may name types that there are no more.
    """
    file = getattr(dispatcher._cache, "_cache_file", None)
    if file is not None:
        file._version = f"{file._version} {digest_of(source)}"
    return dispatcher


def inlined(function: Function) -> Function:
    """Compile a helper that is inlined into kernels of its own file, by Numba: for what calls kernels, in one place."""
    return cast(Function, numba.njit(fastmath=_FASTMATH, error_model="numpy", inline="always")(function))


def leaf(function: Function) -> Function:
    """Compile a helper that LLVM inlines into kernels of its own file: for what is small and used in many places.

    It calls no kernel, and calculates as the first kernel that calls it does: kernels that share one are of one kind.
    It cannot be called from Python.
    """
    compiled = numba.njit(pipeline_class=_LeafCompiler, **_LEAF)(function)
    return cast(Function, _inner(compiled))
