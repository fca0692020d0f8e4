"""What a node of the cluster is, and getting it ready: kernels are compiled once on it, not in each of its workers."""

from dataclasses import dataclass
from typing import NamedTuple

from elbowroom import __version__
from elbowroom.control.recordings.recording import this_machine
from elbowroom.experiment.machine import program_digest


@dataclass(frozen=True)
class NodeKind:
    """What results depend on to the last bit: the program, and what compiles its kernels for which processor."""

    version: str
    program: str  # digest of the code and data on which walks depend
    machine: tuple[tuple[str, str], ...]  # names and values, see `this_machine`

    @classmethod
    def here(cls) -> "NodeKind":
        """That of this process."""
        return cls(__version__, program_digest(), tuple(sorted(this_machine().items())))

    def difference(self, own: "NodeKind") -> str:
        """What is other than here, for people; empty where nothing is."""
        if self.version != own.version:
            return f"its elbowroom is {self.version}, here {own.version}"
        if self.program != own.program:
            return f"its code is not that of elbowroom {own.version} here"
        there, here = dict(self.machine), dict(own.machine)
        other = [name for name in here if there[name] != here[name]]
        return ", ".join(f"its {name} is {there[name]}, here {here[name]}" for name in other)


class Node(NamedTuple):
    """A node that takes tasks."""

    name: str  # in Ray
    address: str
    cores: int  # tasks that it does at once


def made_ready(own: NodeKind) -> str:
    """Runs on a node: what is other there than at `own`; if nothing is, all kernels are compiled when it returns."""
    from elbowroom.server.kernels.compiling import compile_apart
    from elbowroom.server.kernels.kernel_cache import is_warm
    from elbowroom.server.kernels.kernel_files import find_place

    find_place()
    other = NodeKind.here().difference(own)
    if not other and not is_warm():
        compile_apart(lambda _kernel, _number: None)
    return other
