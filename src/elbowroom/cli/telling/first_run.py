"""Kernels are compiled once, by the first command that needs them, and everybody sees how far that is."""

from elbowroom.cli.options.answers import Quiet
from elbowroom.cli.telling.spoken import said
from elbowroom.cli.telling.time_left import time_left_bar

EXAMPLES = "Examples:  elbowroom compile  |  elbowroom compile --quiet"


def compile_(
    *,
    quiet: Quiet = False,
) -> None:
    """Compile all kernels now, one to three minutes; else the first command that needs them does it."""
    compile_first(quiet=quiet)


def compile_first(*, quiet: bool = False) -> None:
    """Compile all that walking needs, unless that is done: counted, with the time that is left, unless `quiet`."""
    from elbowroom.server.kernels.kernel_cache import is_warm

    if is_warm():
        return
    from elbowroom.server.kernels.compiling import compile_apart
    from elbowroom.server.kernels.kernel_cache import session_kernels

    total = len(session_kernels())
    with time_left_bar(said("Compiling kernels, once"), quiet) as move:
        move(0, total)
        compile_apart(lambda kernel, number: move(min(number + 1, total), total))  # noqa: ARG005
