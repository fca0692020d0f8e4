"""What Numba makes of a kernel, what of that is kept on disk, and how much of it is read when it is needed again.

A kernel holds the code of all the kernels that it calls: Numba links their LLVM modules into its own and compiles the
whole. So what only kernels call needs no machine code of its own (a tenth of a first start), and what Python calls
needs its LLVM module only if another kernel that calls it is compiled too. Numba reads these modules whenever it
loads a kernel; here they stay bytes until then (a tenth of a later start, and a third of a server's memory).

This leans on the inner works of Numba, here and in `jit` alone; docs/architecture.md says on which ("The first start").
"""

from typing import Any, NamedTuple, cast

from llvmlite import binding
from numba.core import compiler
from numba.core.caching import CompileResultCacheImpl
from numba.core.codegen import JITCodeLibrary


class Kept(NamedTuple):
    """What `CompileResult._reduce` puts together, and what lies on disk."""

    library: tuple[str, str, tuple[bytes, bytes]]  # its name, its kind, machine code and module
    described: Any
    environment: Any
    signature: Any
    objectmode: bool
    lifted: tuple[Any, ...]
    annotation: str
    reload_init: list[Any]
    environments: tuple[Any, ...]


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
        kept = Kept(*payload)
        return _result(target_context, _unread(LinkedLibrary, target_context, kept), entry_for_kernels(), kept)


class KernelCache(CompileResultCacheImpl):
    """Keeps what Python calls."""

    def rebuild(self, target_context: Any, payload: tuple[Any, ...]) -> Any:
        """The compiled kernel, ready to be called."""
        kept = Kept(*payload)
        library = _unread(LoadedLibrary, target_context, kept)
        (machine_code, _), described = kept.library[2], kept.described
        library.load(machine_code, {described.llvm_func_name, described.llvm_cpython_wrapper_name})
        entry = target_context.get_executable(library, described, kept.environment)
        for environment in kept.environments:
            library.codegen.set_env(environment.env_name, environment)
        return _result(target_context, library, entry, kept)


def entry_for_kernels() -> object:
    """What Numba knows a function by that has no address: one for each."""
    return object()


def _unread(kind: type[Any], target_context: Any, kept: Kept) -> Any:
    """A library with its module unread."""
    for initialize in kept.reload_init:
        initialize()
    name, _, (_, bitcode) = kept.library
    library = kind(target_context.codegen(), name)
    library.bitcode, library._finalized = bitcode, True
    return library


def _result(target_context: Any, library: Any, entry: object, kept: Kept) -> Any:
    """What `CompileResult._rebuild` makes."""
    return cast(Any, compiler.CompileResult)(
        target_context=target_context,
        typing_context=target_context.typing_context,
        library=library,
        environment=kept.environment,
        entry_point=entry,
        fndesc=kept.described,
        type_annotation=kept.annotation,
        signature=kept.signature,
        objectmode=kept.objectmode,
        lifted=kept.lifted,
        typing_error=None,
        call_helper=None,
        metadata=None,
        reload_init=kept.reload_init,
        referenced_envs=kept.environments,
    )
