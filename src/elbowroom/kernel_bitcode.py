"""What a kernel that was read from disk keeps for others that will call it: LLVM's bitcode, unread until one does.

Beside the machine code Numba reads a kernel's bitcode into a module of LLVM, as whoever is compiled with a call to the
kernel takes it in. A module takes ten times the memory of its bitcode, and a program that compiles nothing has no use
for it: 140 of the 320 MB of a server with 130 kernels.

Numba has no option for this. Where a version of it names the module differently all is as it was, and larger.
"""

from typing import Any

from llvmlite.binding import ModuleRef, parse_bitcode


class UnreadModule:
    """Stands for a module of LLVM that is read when it is asked for a clone, as who links it does."""

    def __init__(self, bitcode: bytes) -> None:
        self._bitcode = bitcode

    def clone(self) -> ModuleRef:
        """The module, for whoever takes it in."""
        return parse_bitcode(self._bitcode)


def leave_unread(result: Any) -> None:
    """Put bitcode in the place of the module that a kernel holds for its callers; `result` is what Numba read."""
    library = getattr(result, "library", None)
    module = getattr(library, "_shared_module", None)
    if isinstance(module, ModuleRef):
        library._shared_module = UnreadModule(module.as_bitcode())  # type: ignore[union-attr]
