"""What compiled code keeps: a NamedTuple of arrays, unpacked once and then handed over in one piece.

Whenever Python calls a kernel, each array among the arguments is unpacked anew, a third of a microsecond apiece and
more where they have left the caches: for the ninety arrays that a search looks at, a good part of a short one. A kernel
that takes something held reads its `value` and goes on as if it had been given the tuple itself; Python reads the same
tuple under the same name. The arrays are shared. Which arrays they are never changes.
"""

from typing import Any, Generic, TypeVar, cast

from numba.core import types
from numba.experimental import structref

from elbowroom.jit import exact_kernel

Value = TypeVar("Value", bound=tuple[Any, ...])

_structref = cast(Any, structref)  # which has no types


@structref.register
class HeldType(types.StructRef):
    """What Numba knows of `Held`: the type of its value."""


class Held(structref.StructRefProxy, Generic[Value]):
    """A NamedTuple that kernels can take in one piece; made by `hold`."""

    __slots__ = ("value",)
    value: Value


_structref.define_proxy(Held, HeldType, ["value"])
_made: Any = Held


@exact_kernel
def _unpacked(value: Any) -> Any:
    """What compiled code keeps of `hold`; it is compiled once for each type of value."""
    return _made(value)


def hold(value: Value) -> Held[Value]:
    """Keep a NamedTuple of arrays, numbers and other such tuples for kernels that take it as `Held`."""
    held: Held[Value] = _unpacked(value)
    held.value = value
    return held
