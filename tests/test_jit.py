"""Kernels that only kernels call: refused where Python calls them, and none has a wrapper that nobody uses."""

import ast
import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import elbowroom
from elbowroom.jit import exact_inner_kernel, exact_kernel, exact_lean_kernel, inner_kernel, leaf, lean_kernel

PACKAGE = Path(elbowroom.__file__).parent
TESTS = Path(__file__).parent
OUTER, INNER = {"kernel", "exact_kernel"}, {"inner_kernel", "exact_inner_kernel", "inlined", "leaf"}
LEAN = {"lean_kernel", "exact_lean_kernel"}
INNER |= LEAN


@leaf
def halved(number: float) -> float:
    return 0.5 * number


@exact_inner_kernel
def one_less(number: float) -> float:
    return number - 1.0


@inner_kernel
def doubled(number: float) -> float:
    return 2.0 * number


@exact_lean_kernel
def squared(number: float) -> float:
    return number * number


@lean_kernel
def negated(number: float) -> float:
    return -number


@exact_kernel
def all_of_them(number: float) -> float:
    return squared(negated(halved(one_less(doubled(number)))))


@pytest.mark.parametrize("called", [halved, one_less, doubled, squared, negated])
def test_a_call_from_python_is_an_error_before_and_after_a_kernel_called_it(called: Callable[[float], float]) -> None:
    for _ in range(2):
        with pytest.raises(TypeError, match=f"{called.__name__} is called by kernels only"):
            called(3.0)
        assert all_of_them(3.0) == 6.25


def kind_of(function: ast.FunctionDef) -> str | None:
    """The decorator that makes it a kernel."""
    names = {decorator.id for decorator in function.decorator_list if isinstance(decorator, ast.Name)}
    return next(iter(names & (OUTER | INNER)), None)


def kernels_of(kinds: set[str]) -> set[tuple[str, str]]:
    """The modules and names of the package's kernels of these kinds."""
    found = set()
    for path in PACKAGE.rglob("*.py"):
        module = ".".join(("elbowroom", *path.relative_to(PACKAGE).with_suffix("").parts))
        functions = (node for node in ast.parse(path.read_text("utf-8")).body if isinstance(node, ast.FunctionDef))
        found |= {(module, function.name) for function in functions if kind_of(function) in kinds}
    return found


def outside_kernels(node: ast.AST) -> Iterator[ast.AST]:
    """All of a syntax tree but the insides of kernels."""
    for child in ast.iter_child_nodes(node):
        if not (isinstance(child, ast.FunctionDef) and kind_of(child)):
            yield child
            yield from outside_kernels(child)


def used_by_python(path: Path, root: Path) -> Iterator[tuple[str, str]]:
    """The modules and names of what a file's functions and classes use, kernels aside."""
    tree = ast.parse(path.read_text("utf-8"))
    here = ".".join((root.name, *path.relative_to(root).with_suffix("").parts))
    imported = {
        alias.asname or alias.name: (node.module or "", alias.name)
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    for node in outside_kernels(tree):
        if isinstance(node, ast.Name):
            yield imported.get(node.id, (here, node.id))
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in imported:
            yield ".".join(imported[node.value.id]), node.attr


def used() -> set[tuple[str, str]]:
    return {use for root in (PACKAGE, TESTS) for path in root.rglob("*.py") for use in used_by_python(path, root)}


def test_python_calls_no_kernel_that_is_for_kernels_only() -> None:
    wrong = sorted(kernels_of(INNER - {"inlined"}) & used())
    assert not wrong, f"make these a kernel or exact_kernel, Python uses them: {wrong}"


def test_no_kernel_has_a_wrapper_for_python_that_nobody_uses() -> None:
    idle = sorted(kernels_of(OUTER) - used())
    assert not idle, f"make these an inner_kernel or exact_inner_kernel, Python does not use them: {idle}"


def kernels_called(module: str, function: ast.FunctionDef, tree: ast.Module) -> Iterator[tuple[str, str]]:
    """The modules and names of what a kernel calls by name."""
    imported = {
        alias.asname or alias.name: (node.module or "", alias.name)
        for node in tree.body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    for node in ast.walk(function):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            yield imported.get(node.func.id, (module, node.func.id))
        elif (
            isinstance(node, ast.Call)
            and isinstance(node.func, ast.Attribute)
            and isinstance(node.func.value, ast.Name)
        ):
            yield ".".join(imported.get(node.func.value.id, (module, ""))), node.func.attr


def test_who_counts_no_references_is_handed_none() -> None:
    returned, calls, plain = {}, set(), {"None", "Any", "bool", "float", "int", "tuple"}
    for path in sorted(PACKAGE.rglob("*.py")):
        module = ".".join(("elbowroom", *path.relative_to(PACKAGE).with_suffix("").parts))
        tree = ast.parse(path.read_text("utf-8"))
        plain |= {node.name for node in tree.body if isinstance(node, ast.ClassDef) and is_tuple_of(node, plain)}
        for function in (node for node in tree.body if isinstance(node, ast.FunctionDef)):
            if kind_of(function) not in {None, "inlined"}:
                returned[module, function.name] = words_in(function.returns)
            if kind_of(function) in LEAN:
                calls |= {(called, function.name) for called in kernels_called(module, function, tree)}
    assert len(calls) > 100
    wrong = sorted((*called, caller) for called, caller in calls if not returned.get(called, plain) <= plain)
    assert not wrong, f"these return arrays, which nobody would free: {wrong}"


def is_tuple_of(node: ast.ClassDef, plain: set[str]) -> bool:
    """Whether a class is a NamedTuple with fields of these types only."""
    fields = (field.annotation for field in node.body if isinstance(field, ast.AnnAssign))
    return [ast.unparse(base) for base in node.bases] == ["NamedTuple"] and all(words_in(f) <= plain for f in fields)


def words_in(annotation: ast.expr | None) -> set[str]:
    return set(re.findall(r"\w+", ast.unparse(annotation))) if annotation else {"nothing said"}
