"""What Numba makes of a kernel, what of that is kept on disk, and how much of it is read when it is needed again.

A kernel holds the code of all the kernels that it calls: Numba links their LLVM modules into its own and compiles the
whole. So what only kernels call needs no machine code of its own (a tenth of a first start), and what Python calls
needs its LLVM module only if another kernel that calls it is compiled too. Numba reads these modules whenever it
loads a kernel; here they stay bytes until then (a tenth of a later start, and a third of a server's memory).

This leans on the inner works of Numba, here and in `jit` alone; docs/architecture.md says on which ("The first start").
"""

from typing import Any, cast

from llvmlite import binding
from numba.core import compiler
from numba.core.caching import CompileResultCacheImpl
from numba.core.codegen import JITCodeLibrary

_RELOAD_INIT, _ENVIRONMENTS = 6, 7  # places in what `CompileResult._reduce` puts together, after the library


class LinkedLibrary(JITCodeLibrary):
    """A function that is linked into others and never called by itself: optimised, but not made machine code."""

    bitcode: bytes | None = None  # what its module is made of when it is needed

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        self._finalized = True

    def _get_compiled_object(self) -> bytes:
        return b""

    def _get_module_for_linking(self) -> Any:
        if self.bitcode is not None:
            self._shared_module, self.bitcode = binding.parse_bitcode(self.bitcode), None
        return super()._get_module_for_linking()


class LoadedLibrary(LinkedLibrary):
    """A kernel read from disk that Python calls: its machine code is there, its module when it is needed."""

    def load(self, machine_code: bytes, names: set[str]) -> None:
        """Hand machine code to the engine; `names` are functions that are called by address."""
        self.enable_object_caching()
        self._set_compiled_object(machine_code)
        JITCodeLibrary._finalize_final_module(self)
        self._codegen._engine._defined_symbols |= names


class LinkedCache(CompileResultCacheImpl):
    """Keeps what only kernels call."""

    def rebuild(self, target_context: Any, payload: tuple[Any, ...]) -> Any:
        """The compiled function, with a module that is read when another is compiled that calls it."""
        library, rest = _unread(LinkedLibrary, target_context, payload)
        return _result(target_context, library, entry_for_kernels(), rest)


class KernelCache(CompileResultCacheImpl):
    """Keeps what Python calls."""

    def rebuild(self, target_context: Any, payload: tuple[Any, ...]) -> Any:
        """The compiled kernel, ready to be called."""
        library, rest = _unread(LoadedLibrary, target_context, payload)
        machine_code, described, environment = payload[0][2][0], rest[0], rest[1]
        library.load(machine_code, {described.llvm_func_name, described.llvm_cpython_wrapper_name})
        entry = target_context.get_executable(library, described, environment)
        for one in rest[_ENVIRONMENTS]:
            library.codegen.set_env(one.env_name, one)
        return _result(target_context, library, entry, rest)


def entry_for_kernels() -> object:
    """What Numba knows a function by that has no address: one for each."""
    return object()


def _unread(kind: type[Any], target_context: Any, payload: tuple[Any, ...]) -> tuple[Any, tuple[Any, ...]]:
    """A library with its module unread, and the rest of what `CompileResult._reduce` has put together."""
    (name, _, (_, bitcode)), *rest = payload
    for initialize in rest[_RELOAD_INIT]:
        initialize()
    library = kind(target_context.codegen(), name)
    library.bitcode, library._finalized = bitcode, True
    return library, tuple(rest)


def _result(target_context: Any, library: Any, entry: object, rest: tuple[Any, ...]) -> Any:
    """What `CompileResult._rebuild` makes."""
    described, environment, signature, objectmode, lifted, annotation, reload_init, environments = rest
    return cast(Any, compiler.CompileResult)(
        target_context=target_context,
        typing_context=target_context.typing_context,
        library=library,
        environment=environment,
        entry_point=entry,
        fndesc=described,
        type_annotation=annotation,
        signature=signature,
        objectmode=objectmode,
        lifted=lifted,
        typing_error=None,
        call_helper=None,
        metadata=None,
        reload_init=reload_init,
        referenced_envs=environments,
    )
