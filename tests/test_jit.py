"""The kinds of compiled functions, and what they ask of Numba."""

import ast
import os
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

import numba
import numpy as np
import pytest

import elbowroom
from elbowroom.jit import exact_kernel, helper, inner_exact_kernel, inner_kernel, kernel, kernels_made, plain
from sources import COMPILED, ENTERED, EXACT, INNER, nodes_of, tree_of

PACKAGE = Path(elbowroom.__file__).parent


@helper
def halved(number: float) -> float:
    return 0.5 * number


@exact_kernel
def one_less(number: float) -> float:
    return number - 1.0


@kernel
def combined(number: float, times: int) -> float:
    for _ in range(times):
        number = halved(one_less(number))
    return number


_TWICE = plain(2)


@exact_kernel
def nested(number: float) -> float:
    return combined(number, _TWICE)


def test_kinds_call_each_other_and_are_called_from_python() -> None:
    assert combined(7.0, 2) == nested(7.0) == 1.0
    assert one_less(3.0) == 2.0


def test_a_plain_constant_asks_for_no_compilation_of_its_own() -> None:
    combined(7.0, 2)
    nested(7.0)
    (made,) = (one for one in kernels_made() if one.py_func.__name__ == "combined")
    assert len(made.signatures) == 1


@inner_kernel
def inner_tripled(number: float) -> float:
    return 3.0 * number


@inner_exact_kernel
def inner_less(number: float) -> float:
    return inner_tripled(number) - 1.0


@exact_kernel
def entered(number: float) -> float:
    return inner_less(number)


def test_who_calls_an_inner_kernel_from_python_is_told_so() -> None:
    """Numba has no code for that, and would end the process."""
    assert entered(2.0) == 5.0
    for inner in (inner_tripled, inner_less):
        for arguments in ((2.0,), (2,), ()):
            with pytest.raises(TypeError, match=f"{inner.__name__} is called by other kernels alone"):
                inner(*arguments)


def _named_outside_of_kernels(path: Path) -> Iterator[tuple[str, str]]:
    """What a file names where Python reads it: the module that it comes from, and its name there."""
    tree, own = tree_of(path), ".".join(("elbowroom", *path.with_suffix("").parts[len(PACKAGE.parts) :]))
    taken = {alias.asname or alias.name: (node.module or "", alias.name)
             for node in nodes_of(path) if isinstance(node, ast.ImportFrom) for alias in node.names}  # fmt: skip
    compiled = {id(inside) for node in tree.body if _kinds_of(node) for inside in ast.walk(node)}
    for node in nodes_of(path):
        if isinstance(node, ast.Name):
            named = taken.get(node.id, (own, node.id))
        elif isinstance(node, ast.Attribute):
            named = "", node.attr
        else:
            continue
        if id(node) not in compiled:
            yield named


def _kinds_of(node: ast.AST) -> set[str]:
    marks = node.decorator_list if isinstance(node, ast.FunctionDef) else []
    return COMPILED & {mark.id for mark in marks if isinstance(mark, ast.Name)}


def test_what_only_kernels_call_has_no_entrance_from_python() -> None:
    """An entrance is a third of what compiling a kernel costs."""
    root = PACKAGE.parents[1]
    files = [path for folder in (PACKAGE, root / "tests", root / "tools") for path in folder.rglob("*.py")]
    named = {name for path in files for name in _named_outside_of_kernels(path)}
    wrong = {}
    for path in PACKAGE.rglob("*.py"):
        own = ".".join(("elbowroom", *path.relative_to(PACKAGE).with_suffix("").parts))
        for node in tree_of(path).body:
            if isinstance(node, ast.FunctionDef) and (kinds := _kinds_of(node) - {"helper"}):
                entered = bool({(own, node.name), ("", node.name)} & named)
                if entered != bool(kinds & ENTERED):
                    wrong[f"{own}.{node.name}"] = "is entered" if entered else "is never entered"
    assert not wrong


def test_every_kernel_is_one_of_these_kinds() -> None:
    for path in PACKAGE.rglob("*.py"):
        text = path.read_text("utf-8")
        assert not re.search(r"@numba|import njit", text), f"{path} compiles by itself"
        for node in nodes_of(path):
            if isinstance(node, ast.ImportFrom) and node.module == "elbowroom.jit":
                assert {alias.name for alias in node.names} <= COMPILED | {"plain", "kernels_made"}, path


def test_no_private_part_of_numba_is_used() -> None:
    """`numba.core.event` is documented, and `numba.extending.infer_getattr` takes what is derived from its template.

    So is how a step is added to the compiler ("Customizing the Compiler"). No other module of the compiler is touched.
    """
    steps = (
        r"compiler import CompilerBase, DefaultPassBuilder$",
        r"compiler_machinery import LoweringPass, register_pass$",
        r"typed_passes import IRLegalization$",
    )
    allowed = "|".join((r"event\b", r"typing\.templates import AttributeTemplate$", *steps))
    private = re.compile(rf"numba\.core\.(?!{allowed})\w+|from numba\.core import (?!event$)\w+", re.MULTILINE)
    for path in PACKAGE.rglob("*.py"):
        assert not private.findall(path.read_text("utf-8")), path


def test_the_version_of_numba_is_one_that_was_tried() -> None:
    project = tomllib.loads((PACKAGE.parents[1] / "pyproject.toml").read_text("utf-8"))["project"]
    (wanted,) = (line for line in project["dependencies"] if re.match(r"numba\b", line))
    assert wanted == "numba>=0.62,<0.69"
    assert (0, 62) <= tuple(map(int, numba.__version__.split(".")[:2])) < (0, 69)


def test_fast_and_exact_mathematics_are_told_apart() -> None:
    """A sum that fast mathematics may reorder; the exact one is as NumPy's plain loop has it."""
    values = np.random.default_rng(0).normal(size=1001) * 10.0 ** np.arange(1001) ** 0.3

    @exact_kernel
    def total(numbers: np.ndarray) -> float:
        out = 0.0
        for number in numbers:
            out += number
        return out

    expected = 0.0
    for value in values:
        expected += value
    assert total(values) == pytest.approx(expected, abs=0.0)


@pytest.mark.parametrize(("told_before", "warnings"), [(False, 1), (True, 0)])
def test_who_can_keep_no_kernels_hears_it_once(told_before: bool, warnings: int) -> None:
    code = (
        "import elbowroom.kernel_cache as kept; kept._is_writable = lambda folder: False; "
        "import elbowroom.body.gait.cycle, elbowroom.body.pose.posing"
    )
    environment = {name: value for name, value in os.environ.items() if name != "NUMBA_CACHE_DIR"}
    if told_before:
        environment["NUMBA_CACHE_DIR"] = os.devnull
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment)
    assert done.stderr.count("RuntimeWarning: no folder for compiled kernels") == warnings
    assert done.stderr.count("set NUMBA_CACHE_DIR") == warnings


def _calls(tree: ast.Module) -> Iterator[tuple[ast.Call, bool]]:
    """All calls in the functions of a file, and whether it is compiled code that calls."""
    for function in ast.walk(tree):
        if isinstance(function, ast.FunctionDef):
            compiled = any(isinstance(mark, ast.Name) and mark.id in COMPILED for mark in function.decorator_list)
            yield from ((node, compiled) for node in ast.walk(function) if isinstance(node, ast.Call))


def _literal(argument: ast.expr, module: object) -> object:
    """The whole number that an argument is to Numba by itself, a type of its own; None for all others."""
    try:
        value = ast.literal_eval(argument)
    except ValueError:
        value = getattr(module, argument.id, None) if isinstance(argument, ast.Name) else None
    return value if type(value) in (int, bool) else None


def test_kernels_call_each_other_with_the_same_literals_or_with_none() -> None:
    """To Numba a literal is a type of its own: a kernel that is called with another one is compiled once more."""
    seen: dict[object, dict[int, set[object]]] = {}
    modules = {path: import_module(".".join(("elbowroom", *path.relative_to(PACKAGE).with_suffix("").parts)))
               for path in sorted(PACKAGE.rglob("*.py")) if path.name != "__main__.py"}  # fmt: skip
    kernels = {id(made) for made in kernels_made()}
    for path, module in modules.items():
        for call, compiled in _calls(tree_of(path)):
            called = getattr(module, call.func.id, None) if isinstance(call.func, ast.Name) else None
            if id(called) in kernels:
                for place, argument in enumerate(call.args):
                    literal = _literal(argument, module) if compiled else None
                    seen.setdefault(called, {}).setdefault(place, set()).add(literal)
    assert len(seen) > 100
    several = {
        f"{made.py_func.__module__}.{made.py_func.__name__}, argument {place}": found  # type: ignore[attr-defined]
        for made, places in seen.items()
        for place, found in places.items()
        if len(found) > 1
    }
    assert not several, several


def _exact(kinds: set[str]) -> bool | None:
    """Whether a function is compiled with exact mathematics; None where it is not compiled by itself."""
    return bool(kinds & EXACT) if kinds & (ENTERED | INNER) else None


def _private_kernels_called_once(tree: ast.Module) -> Iterator[str]:
    """Names of a file's private kernels that are named in one place there: within a kernel of the same kind."""
    functions = [node for node in tree.body if isinstance(node, ast.FunctionDef)]
    kinds = {one.name: {mark.id for mark in one.decorator_list if isinstance(mark, ast.Name)} for one in functions}
    named = [(node.id, one.name) for one in functions for node in ast.walk(one) if isinstance(node, ast.Name)]
    for name in sorted(name for name in kinds if name.startswith("_") and kinds[name] & (COMPILED - {"helper"})):
        callers = [caller for called, caller in named if called == name]
        if len(callers) == 1 and _exact(kinds[callers[0]]) == _exact(kinds[name]):
            yield name


def test_what_a_kernel_alone_calls_in_one_place_is_a_helper() -> None:
    """It would be compiled twice: alone, and within the kernel that calls it."""
    twice = {str(path): list(_private_kernels_called_once(tree_of(path)))
             for path in PACKAGE.rglob("*.py")}  # fmt: skip
    assert {path: names for path, names in twice.items() if names} == {}
