"""The project's own source, parsed once for all laws about it."""

import ast
from functools import cache
from pathlib import Path

EXACT = {"exact_kernel", "brief_exact_kernel", "inner_exact_kernel"}  # kinds of compiled functions, see `elbowroom.jit`
ENTERED = {"kernel", "exact_kernel", "brief_kernel", "brief_exact_kernel"}  # those that Python may call
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
