"""What a kernel keeps for others that will call it: LLVM's bitcode, in a file of its own, unread until one does.

Beside the machine code Numba keeps a kernel's bitcode, for whoever is compiled with a call to the kernel to take it in,
and reads both whenever the kernel is first called. Reading it takes longer than all the rest, and ten times the memory
of the file; a program that compiles nothing has no use for it. So Numba is handed a module that only names the
functions of the kernel, and the bitcode lies beside.

Numba has no option for this.
"""

import hashlib
import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from llvmlite import ir
from llvmlite.binding import Linkage, ModuleRef, ValueRef, parse_assembly

from elbowroom.kernel_library import UnreadModule


class Bitcode:
    """That of one kernel for one signature."""

    def __init__(self, folder: Path, name: str, signature: Any) -> None:
        """It lies in `folder`, in a file whose name begins with `name`."""
        self._folder, self._name, self._signature = folder, name, signature

    @contextmanager
    def written_apart(self, code: Any) -> Iterator[None]:
        """What Numba writes of compiled `code` meanwhile has no bitcode: that is in its file. Raises `OSError`."""
        library = getattr(code, "library", None)
        if not hasattr(library, "_shared_module"):
            yield
            return
        whole, file = library._get_module_for_linking(), self._file(code)  # type: ignore[union-attr]
        new = file.with_suffix(f".{os.getpid()}")
        try:
            new.write_bytes(whole.as_bitcode())
            new.replace(file)
        finally:
            new.unlink(missing_ok=True)
        library._shared_module = _outline(library.get_defined_functions())  # type: ignore[union-attr]
        try:
            yield
        finally:
            library._shared_module = whole  # type: ignore[union-attr]

    def leave_unread(self, code: Any) -> bool:
        """Let callers of `code`, as Numba read it, find its bitcode in the file; whether it is there.

        Without, they would take in functions that do nothing.
        """
        library = getattr(code, "library", None)
        if not hasattr(library, "_shared_module"):
            return True
        file = self._file(code)
        library._shared_module = UnreadModule(file.read_bytes)  # type: ignore[union-attr]
        return file.exists()

    def _file(self, code: Any) -> Path:
        """Where it lies: another processor's is another file."""
        told = repr((self._signature, code.target_context.codegen().magic_tuple()))
        return self._folder / f"{self._name}.{hashlib.sha256(told.encode()).hexdigest()[:16]}.bc"


def _outline(functions: Iterable[ValueRef]) -> ModuleRef:
    """A module with functions of the same names that do nothing: by them Numba knows what there is."""
    outline, nothing = ir.Module(), ir.FunctionType(ir.VoidType(), ())
    for function in functions:
        if function.linkage == Linkage.external:
            named = ir.Function(outline, nothing, function.name)
            named.linkage = "linkonce_odr"
            ir.IRBuilder(named.append_basic_block()).ret_void()
    return parse_assembly(str(outline))
