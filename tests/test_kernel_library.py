"""What a kernel calls is its own, and is taken in as it is on disk."""

import os
from typing import Any

import numba
import numpy as np
import pytest
from llvmlite.binding import Linkage, parse_bitcode
from numba.core.compiler import CompilerBase

import elbowroom.planning.exact.planner  # noqa: F401  # it makes them
from elbowroom.jit import kernels_made
from elbowroom.kernel_library import KernelCompiler, UnreadModule

FAST: dict[str, Any] = {"fastmath": True, "pipeline_class": KernelCompiler}  # not kept: compiled here each time


@numba.njit(**FAST)  # type: ignore[untyped-decorator]
def total(numbers: np.ndarray) -> float:
    """By halves: LLVM takes no function that calls itself twice into another."""
    if len(numbers) < 2:
        return float(numbers[0])
    half = len(numbers) // 2
    return float(total(numbers[:half]) + total(numbers[half:]))


@numba.njit(**FAST)  # type: ignore[untyped-decorator]
def of_both(numbers: np.ndarray) -> float:
    return float(total(numbers) + total(numbers[1:]))


@pytest.fixture(scope="module")
def library() -> Any:
    assert of_both(np.arange(4.0)) == total(np.arange(4.0)) * 2.0 == 12.0
    (made,) = of_both.overloads.values()
    return made.library


def test_what_a_kernel_calls_is_its_own(library: Any) -> None:
    functions = {function.name: function.linkage for function in library.get_defined_functions()}
    assert any("total" in name for name in functions)
    for name, linkage in functions.items():
        own = "of_both" in name
        assert linkage == (Linkage.external if own else Linkage.internal), name


def test_who_takes_a_kernel_in_may_take_in_what_it_calls_from_others_too(library: Any) -> None:
    module = library._get_module_for_linking()
    assert isinstance(module, UnreadModule)
    assert module.clone().as_bitcode() == parse_bitcode(module.as_bitcode()).as_bitcode()
    assert {f.linkage for f in module.clone().functions if not f.is_declaration} == {Linkage.linkonce_odr}


def test_all_kernels_are_compiled_so() -> None:
    assert len(kernels_made()) > 100
    assert {one._compiler.pipeline_class for one in kernels_made()} == {KernelCompiler}


@pytest.mark.skipif("NUMBA_OPT" in os.environ, reason="NUMBA_OPT is set, and counts")
def test_kernels_are_optimised_at_their_own_level_and_code_of_others_is_not(monkeypatch: pytest.MonkeyPatch) -> None:
    levels, compiled, config = list[int](), CompilerBase.compile_extra, numba.config

    def seen(compiler: CompilerBase, function: Any) -> Any:
        levels.append(int(config.OPT))  # type: ignore[attr-defined]
        return compiled(compiler, function)  # type: ignore[no-untyped-call]

    monkeypatch.setattr(CompilerBase, "compile_extra", seen)
    for options in (FAST, {}, FAST):
        assert numba.njit(lambda number: 2 * number, **options)(3) == 6
    assert levels == [1, 3, 1]


@numba.njit(**FAST)  # type: ignore[untyped-decorator]
def raised(number: float, power: int) -> float:
    return float(number**power)


@numba.njit(pipeline_class=KernelCompiler)
def raised_exactly(number: float, power: int) -> float:
    return float(number**power)


def test_fast_mathematics_stay_out_of_exact_kernels() -> None:
    """A power stands for a function, which Numba compiles once: here, for the fast kernel first."""
    texts = []
    for kernel in (raised, raised_exactly):
        assert kernel(3.0, 2) == 9.0
        made: Any = next(iter(kernel.overloads.values()))
        texts.append(str(made.library._get_module_for_linking().clone()))
    assert [" fast " in text for text in texts] == [True, False]
