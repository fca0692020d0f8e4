"""What a kernel computes does not hang on what was compiled, or called, before it.

Numba takes the functions that a kernel calls into the kernel's module, and LLVM compiles them there, as it does in all
other kernels that call them: the same function, but not to the last bit, for it is optimised together with what calls
it. LLVM knows the functions of all modules by their names, and of one name takes the first that came into the process.
Here they are the module's own: they are made internal to it when all is optimised, before it becomes machine code.

Numba compiles what stands for an operation, such as a power, once in a process, with the mathematics of the kernel that
needed it first: fast mathematics came into exact kernels so. Here each kind of mathematics has its own.

Numba has no option for either. It documents how to add a step to its compiler, and that step hands a kernel what both
need; the names of what a library does at its end are private to Numba.

LLVM optimises kernels at its level 1, not at Numba's 3: they take a third less time to compile, and none was found to
run slower, for loops become vectors at either. Code of others in this process is optimised as they have it.
"""

import os
from collections import defaultdict
from collections.abc import Callable
from functools import cache
from typing import Any

import numba
from llvmlite.binding import Linkage, ModuleRef, parse_bitcode
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import LoweringPass, register_pass
from numba.core.typed_passes import IRLegalization

config: Any = numba.config
_LEVEL = config.OPT if "NUMBA_OPT" in os.environ else type(config.OPT)(1)  # who has set it knows better
_operations: dict[frozenset[str], Any] = defaultdict(dict)  # what stands for them, by the kind of mathematics


class KernelCompiler(CompilerBase):
    """Numba's compiler, with one step before machine code is made."""

    def define_pipelines(self) -> list[Any]:
        """The steps, in their order."""
        builder: Any = DefaultPassBuilder
        pipeline = builder.define_nopython_pipeline(self.state)
        pipeline.add_pass_after(_Apart, IRLegalization)
        pipeline.finalize()
        return [pipeline]

    def compile_extra(self, func: Any) -> Any:
        """Compile a function, optimised at `_LEVEL`."""
        before, config.OPT = config.OPT, _LEVEL
        try:
            return super().compile_extra(func)  # type: ignore[no-untyped-call]
        finally:
            config.OPT = before


@register_pass(mutates_CFG=False, analysis_only=True)  # type: ignore[no-untyped-call]
class _Apart(LoweringPass):
    """Tells a kernel apart from others that are compiled in this process."""

    _name = "apart"

    def __init__(self) -> None:
        """Numba asks for it."""
        super().__init__()  # type: ignore[no-untyped-call]

    def run_pass(self, state: Any) -> bool:
        """Begin the library as the next step would, in which all is told that becomes machine code."""
        state.targetctx.cached_internal_func = _operations[frozenset(state.flags.fastmath.flags)]
        library = state.targetctx.codegen().create_library(state.func_id.func_qualname)
        library.enable_object_caching()
        kind: Any = type(library)
        library.__class__ = _closed(kind)
        state.library = library
        return False


class UnreadModule:
    """Stands for a module of LLVM where Numba links it into another: its bitcode is read each time.

    What was read is not ordered as what was written, and LLVM optimises it to other last bits. So who compiles a kernel
    and what it calls takes in the same as who finds the latter on disk.
    """

    def __init__(self, bitcode: Callable[[], bytes]) -> None:
        """`bitcode` answers it."""
        self.as_bitcode = bitcode

    def clone(self) -> ModuleRef:
        """The module, for whoever takes it in."""
        return parse_bitcode(self.as_bitcode())


@cache
def _closed(libraries: Any) -> type:
    """Numba's class of libraries, of modules that call no function of another."""

    def finish(library: Any) -> None:
        bitcode = _to_link(library._final_module)
        library._shared_module = UnreadModule(lambda: bitcode)
        for function in library._final_module.functions:
            if function.linkage == Linkage.linkonce_odr:
                function.linkage = Linkage.internal
        libraries._finalize_final_module(library)

    return type(libraries.__name__, (libraries,), {"_finalize_final_module": finish})


def _to_link(module: ModuleRef) -> bytes:
    """The bitcode of a module that several others may take in, each of which may hold the same functions."""
    shared = module.clone()
    for function in shared.functions:
        if not function.is_declaration and function.linkage == Linkage.external:
            function.linkage = Linkage.linkonce_odr
    return bytes(shared.as_bitcode())
