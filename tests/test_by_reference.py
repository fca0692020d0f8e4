"""Tuples that kernels are handed by reference: the same to Python, and one pointer to kernels."""

import copy
import pickle
import sys
from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar, cast

import numba
import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.by_reference import by_reference

Floats = NDArray[np.float64]
Function = TypeVar("Function", bound=Callable[..., Any])


def compiled(function: Function) -> Function:
    return cast(Function, numba.njit(function))


def code_of(function: Any) -> Any:
    return function


@by_reference
class Inner(NamedTuple):
    """Two of its fields are arrays."""

    numbers: Floats
    shifts: NDArray[np.float32]
    size: int


class Plain(NamedTuple):
    """Numba's own way, among those by reference."""

    inner: Inner
    factor: float


@by_reference
class Outer(NamedTuple):
    """One within one, and a tuple of the usual kind."""

    plain: Plain
    inner: Inner
    chosen: bool
    place: tuple[float, int]


def made(size: int = 4) -> Outer:
    numbers = np.arange(size * 3.0).reshape(size, 3)
    inner = Inner(numbers, np.full(3, 0.5, np.float32), size)
    return Outer(Plain(inner._replace(size=1), 2.0), inner, True, (0.25, 7))


@compiled
def total_of(inner: Inner, first: int) -> float:
    total = 0.0
    for i in range(first, inner.numbers.shape[0]):
        for k in range(inner.shifts.shape[0]):
            total += inner.numbers[i, k] + inner.shifts[k]
    return total + inner.size


@compiled
def told(outer: Outer) -> tuple[float, float, float]:
    place, number = outer.place
    if not outer.chosen:
        return 0.0, 0.0, 0.0
    outer.inner.numbers[0, 0] = 100.0
    return total_of(outer.inner, 0), outer.plain.factor * total_of(outer.plain.inner, 1), place + number


def naive(outer: Outer) -> tuple[float, float, float]:
    def total(inner: Inner, first: int) -> float:
        return float((inner.numbers[first:] + inner.shifts).sum()) + inner.size

    outer.inner.numbers[0, 0] = 100.0
    return total(outer.inner, 0), outer.plain.factor * total(outer.plain.inner, 1), sum(outer.place)


def test_kernels_see_what_python_sees() -> None:
    for size in (1, 4, 9):
        one, other = made(size), made(size)
        assert told(one) == pytest.approx(naive(other))
        assert (one.inner.numbers == other.inner.numbers).all()  # they are the same arrays, not copies
    assert told(made()._replace(chosen=False)) == (0.0, 0.0, 0.0)
    assert len(code_of(told).signatures) == 1


def test_kernels_hand_on_one_pointer() -> None:
    """Numba would hand on seventeen numbers of two arrays, and a count."""

    @compiled
    def only_looked_into(inner: Inner) -> int:
        return inner.size

    assert only_looked_into(made().inner) == 4
    (code,) = code_of(only_looked_into).inspect_llvm().values()
    (begins,) = (line for line in code.splitlines() if line.startswith("define") and "i32 @_ZN" in line)
    assert begins.split("(", 1)[1].count("%") == 3  # where the answer goes, where an error goes, and the tuple


def test_numba_is_told_once_what_a_tuple_is(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[object] = []
    monkeypatch.setattr(numba.core.dispatcher.Dispatcher, "typeof_pyval", lambda _, value: asked.append(value))
    outer = made()
    for _ in range(5):
        told(outer)
        told(made(9))
    assert asked == []


def test_a_copy_is_a_tuple_like_any_other() -> None:
    outer = made()
    told(outer)
    for copied in (pickle.loads(pickle.dumps(outer)), copy.deepcopy(outer), outer._replace(chosen=True)):
        assert type(copied) is Outer
        assert told(copied) == told(outer)
        assert copied.inner.numbers.tolist() == outer.inner.numbers.tolist()


def test_others_fields_are_another_type() -> None:
    """As a kernel for arrays in C order must not be handed one in Fortran's."""
    told(made())
    before, outer = len(code_of(told).signatures), made()
    turned = outer.inner._replace(numbers=np.asfortranarray(outer.inner.numbers))
    twisted = outer._replace(inner=turned, plain=outer.plain._replace(inner=turned))
    other = made()
    assert told(twisted) == pytest.approx(naive(other._replace(plain=other.plain._replace(inner=other.inner))))
    assert len(code_of(told).signatures) == before + 1


def test_arrays_live_as_long_as_anybody_has_them() -> None:
    @compiled
    def rows(inner: Inner) -> tuple[Floats, Floats]:
        return inner.numbers[1], inner.numbers

    for _ in range(50):
        row, numbers = rows(made().inner)
        assert row.tolist() == [3.0, 4.0, 5.0]
        assert numbers[3].tolist() == [9.0, 10.0, 11.0]


def test_kernels_let_go_of_arrays() -> None:
    outer = made()
    inner, held = outer.inner, outer.plain.inner
    arrays = (inner.numbers, inner.shifts, held.numbers)
    told(outer)
    before = [sys.getrefcount(array) for array in arrays]
    for _ in range(10):
        told(outer)
        total_of(inner, 0)
    assert [sys.getrefcount(array) for array in arrays] == before


def test_what_kernels_cannot_do_is_told() -> None:
    @compiled
    def given_back(inner: Inner) -> Inner:
        return inner

    @compiled
    def unpacked(inner: Inner) -> int:
        _, _, size = inner
        return size

    @compiled
    def misnamed(inner: Inner) -> int:
        return int(inner.length)  # type: ignore[attr-defined]

    with pytest.raises(TypeError, match="cannot convert native Inner"):
        given_back(made().inner)
    with pytest.raises(numba.TypingError, match="unpack Inner"):
        unpacked(made().inner)
    with pytest.raises(numba.TypingError, match="length"):
        misnamed(made().inner)
