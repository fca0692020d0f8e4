"""The project's own source, parsed once for all laws about it."""

import ast
from functools import cache
from pathlib import Path

ENTERED = {"kernel", "exact_kernel"}  # kinds of compiled functions that Python may call, as `elbowroom.jit` has them
INNER = {"inner_kernel", "inner_exact_kernel"}  # those that only kernels call
COMPILED = ENTERED | INNER | {"helper"}


@cache
def tree_of(path: Path) -> ast.Module:
    """The parsed file."""
    return ast.parse(path.read_text("utf-8"))


@cache
def nodes_of(path: Path) -> tuple[ast.AST, ...]:
    """All nodes of the parsed file."""
    return tuple(ast.walk(tree_of(path)))
