"""What compiled code keeps: a NamedTuple of arrays, unpacked once and then handed over in one piece.

Whenever Python calls a kernel, each array among the arguments is unpacked anew, a third of a microsecond apiece and
more where they have left the caches: for the ninety arrays that a search looks at, a good part of a short one. A kernel
that takes something held reads its `value` and goes on as if it had been given the tuple itself; Python reads the same
tuple under the same name. The arrays are shared. Which arrays they are never changes.
"""

import inspect
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, Generic, TypeVar, cast

from numba.core import types
from numba.experimental import structref

from elbowroom.jit import exact_kernel, forgotten_with

_structref = cast(Any, structref)  # which has no types

Value = TypeVar("Value", bound=tuple[Any, ...])


@structref.register
class HeldType(types.StructRef):
    """What Numba knows of `Held`: the type of its value."""


class Held(structref.StructRefProxy, Generic[Value]):
    """A NamedTuple that kernels can take in one piece; made by `hold`."""

    __slots__ = ("value",)
    value: Value
    _numba_type_ = _structref.StructRefProxy._type  # asked for at each call: the slot itself, not a function around it


_structref.define_proxy(Held, HeldType, ["value"])
_made: Any = Held


def hold(value: Value) -> Held[Value]:
    """Keep a NamedTuple of arrays, numbers and other such tuples for kernels that take it as `Held`."""
    held = _unpacking(type(value))(value)
    held.value = value
    return held


@cache
def _unpacking(kind: type[Value]) -> Callable[[Value], Held[Value]]:
    """The part of `hold` that is compiled: for each kind of tuple a kernel of its own, kept on disk as long as the
    source of the kind is the same."""

    def unpacked(value: Any) -> Any:
        return _made(value)

    unpacked.__qualname__ = f"unpacked-{kind.__module__}.{kind.__qualname__}"
    kernel: Callable[[Value], Held[Value]] = forgotten_with(Path(inspect.getfile(kind)), exact_kernel(unpacked))
    return kernel
