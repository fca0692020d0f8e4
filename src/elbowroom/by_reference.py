"""Tuples that kernels are handed by reference: one pointer, where Numba hands on every number of every array.

Numba takes a tuple apart wherever a kernel names it or hands it on: an array with two axes is nine numbers, and what a
search knows of a limb is some hundreds. To take tuples apart and put them together again was a large part of what
compiling took. So what Python makes, and kernels look into, is marked with `@by_reference`. It remains the same tuple
to Python; a kernel is handed where it lies, and reads a field of it wherever it names that field.

At each call Numba asks what its arguments are: of a tuple the names of all its fields, and the kind of every array. For
a tuple by reference that is found out once, and the tuple remembers it: so it is for what lives long. Whatever such a
tuple is handed over in is one by reference too, or Numba would ask in Python, and take longer than many a kernel.

Kernels cannot give one back, nor unpack one: they name its fields. One that a kernel makes itself is passed on as
Numba does it, and is another type to the kernels that it is passed to.
"""

import hashlib
from functools import cached_property
from typing import Any, TypeVar, cast

import numba
import numpy as np
from llvmlite import ir
from numba.core.typing.templates import AttributeTemplate

Class = TypeVar("Class", bound=type)

_extending: Any = numba.extending  # Numba's way in for types of one's own, which has no types itself
_NUMBER = ir.IntType(32)
_TYPE = "_numba_type_"  # where Numba looks for the type of what it does not know
_typeof: Any = numba.typeof
_tuples: Any = numba.types.BaseTuple
_arrays: dict[tuple[Any, ...], Any] = {}  # Numba's type of each kind of array


class Reference(numba.types.Type):
    """The type of a reference to a named tuple, which stays where it is until the kernel that was handed it ends."""

    def __init__(self, whole: Any) -> None:
        """`whole` is Numba's type of the tuple. What is named by it has a short name: it is in that of every kernel."""
        self.whole = whole
        digest = hashlib.sha256(str(whole).encode()).hexdigest()[:12]
        super().__init__(f"{whole.instance_class.__name__}_{digest}")

    def type_of(self, field: str) -> Any:
        """Numba's type of a field; None if there is none of that name."""
        fields = self.whole.fields
        return self.whole.types[fields.index(field)] if field in fields else None


class _Named(type):
    """A class of named tuples to Numba, which knows them by `_asdict`, though its tuples are none.

    Of what it takes for a named tuple it asks the names of all fields before it asks for its type.
    """

    def _asdict(cls) -> None:
        """Is there: that is all that Numba wants of it."""


def by_reference(tuples: Class) -> Class:
    """Hand tuples of this class to kernels by reference."""
    named: Any = tuples
    del named._asdict
    members = {
        "__module__": tuples.__module__,
        "__qualname__": tuples.__qualname__,
        "__doc__": tuples.__doc__,
        "__getstate__": lambda _: None,  # a copy finds out anew what it is
        _TYPE: cached_property(lambda value: Reference(_tuple_of(value))),
    }
    kept = _Named(tuples.__name__, (tuples,), members)
    _extending.typeof_impl.register(kept)(lambda value, _: getattr(value, _TYPE))
    return cast(Class, kept)


def _tuple_of(value: Any) -> Any:
    """Numba's type of a tuple by value."""
    return _tuples.from_types([_kind_of(field) for field in value], type(value))


def _kind_of(value: Any) -> Any:
    """Numba's type of a value. Of each kind of array Numba is asked once: it answers slowly."""
    if isinstance(value, np.ndarray):
        flags = value.flags
        alike = value.dtype, value.ndim, flags.c_contiguous, flags.f_contiguous, flags.aligned, flags.writeable
        if alike not in _arrays:
            _arrays[alike] = _typeof(value)
        return _arrays[alike]
    if isinstance(value, tuple) and not hasattr(value, _TYPE):
        return _tuple_of(value)
    return _typeof(value)


class _Pointer(_extending.models.PrimitiveModel):  # type: ignore[misc]
    def __init__(self, models: Any, reference: Reference) -> None:
        super().__init__(models, reference, models.lookup(reference.whole).get_data_type().as_pointer())


class _Fields(AttributeTemplate):
    key = Reference

    def generic_resolve(self, reference: Reference, field: str) -> Any:  # type: ignore[override]
        return reference.type_of(field)


def _laid_down(reference: Reference, python: Any, at: Any) -> Any:
    """Lay what Python hands to a kernel into memory that lasts as long as the call."""
    found, context = at.unbox(reference.whole, python), at.context
    with at.builder.goto_entry_block():
        memory = at.builder.alloca(context.get_data_type(reference.whole))
    context.pack_value(at.builder, reference.whole, found.value, memory)

    def let_go() -> None:
        """Its arrays are Python's alone again, when the kernel has ended."""
        if found.cleanup is not None:
            found.cleanup()
        context.nrt.decref(at.builder, reference.whole, found.value)

    return _extending.NativeValue(memory, cleanup=let_go, is_error=found.is_error)


def _read(context: Any, builder: Any, reference: Reference, pointer: Any, field: str) -> Any:
    """Read a field: an array is one more reference to its numbers, which Numba counts."""
    kind = reference.type_of(field)
    number = reference.whole.fields.index(field)
    place = builder.gep(pointer, [_NUMBER(0), _NUMBER(number)], inbounds=True)
    value = context.unpack_value(builder, kind, place)
    context.nrt.incref(builder, kind, value)
    return value


_extending.register_model(Reference)(_Pointer)
_extending.infer_getattr(_Fields)
_extending.unbox(Reference)(_laid_down)
_extending.lower_getattr_generic(Reference)(_read)
