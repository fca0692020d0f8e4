"""The nodes of a Ray cluster that take tasks: those that are there, are of our kind, and are ready."""

import time
from collections.abc import Callable
from typing import Any

import ray
from ray.util.scheduling_strategies import NodeAffinitySchedulingStrategy

from elbowroom.cluster.node import Node, NodeKind, made_ready
from elbowroom.errors import InputError

_AGAIN = 2.0  # seconds between two looks at who is there

Tell = Callable[[str], None]


class Nodes:
    """Who is there, looked at again and again; `tell` hears in one line of each node that is left out or lost."""

    def __init__(self, most: int, tell: Tell) -> None:
        self._most, self._tell = most, tell  # tasks at once, of all nodes together
        self._own = NodeKind.here()
        self._ready: dict[str, Node] = {}
        self._asked: dict[str, tuple[Node, Any]] = {}  # nodes that are getting ready, and their answers to come
        self._refused: set[str] = set()
        self._looked = -_AGAIN

    @property
    def ready(self) -> tuple[Node, ...]:
        """Nodes that take tasks, with as many cores as may be used of each."""
        left, given = self._most, []
        for node in self._ready.values():
            given.append(node._replace(cores=min(node.cores, left)))
            left -= given[-1].cores
        return tuple(node for node in given if node.cores)

    def wait(self) -> None:
        """Wait until a node is ready; raises `InputError` where none can be."""
        self.look()
        while not self._ready:
            if not self._asked:
                raise InputError("no node of the cluster can take tasks; what is done is kept")
            self.look(_AGAIN)

    def lose(self, name: str) -> None:
        """Leave a node out that does not do what it is given; if it is still there, it is made ready anew."""
        if name in self._ready:
            self._tell(f"node {self._ready.pop(name).address} is gone; its tasks are done again elsewhere")

    def look(self, seconds: float = 0.0) -> None:
        """See who has come, gone or become ready, waiting up to some `seconds` for one that is getting ready."""
        if time.monotonic() - self._looked >= _AGAIN:
            self._looked = time.monotonic()
            self._count()
        waited = {answer: name for name, (_, answer) in self._asked.items()}
        for answer in ray.wait(list(waited), timeout=seconds)[0] if waited else ():
            self._take(waited[answer])

    def _count(self) -> None:
        entries: list[dict[str, Any]] = ray.nodes()  # type: ignore[no-untyped-call]
        alive = {entry["NodeID"]: entry for entry in entries if entry["Alive"]}
        for name in [name for name in self._ready if name not in alive]:
            self.lose(name)
        for name, entry in alive.items():
            cores = int(entry["Resources"].get("CPU", 0))
            if cores and name not in self._ready and name not in self._asked and name not in self._refused:
                node = Node(name, entry["NodeManagerAddress"], cores)
                self._asked[name] = node, remote(made_ready, node).remote(self._own)

    def _take(self, name: str) -> None:
        node, answer = self._asked.pop(name)
        try:
            other = ray.get(answer)
        except ray.exceptions.RayError as error:
            other = f"it cannot get ready ({_last_line(error)})"
        if other:
            self._refused.add(name)
            self._tell(f"node {node.address} is left out: {other}")
        else:
            self._ready[name] = node


def remote(function: Callable[..., Any], node: Node) -> Any:
    """A function that runs on one node, once: what is lost is not repeated by Ray, but by who sees it."""
    there = NodeAffinitySchedulingStrategy(node.name, soft=False)
    return ray.remote(function).options(num_cpus=1, max_retries=0, scheduling_strategy=there)


def _last_line(error: Exception) -> str:
    return str(error).strip().splitlines()[-1][:200] if str(error).strip() else type(error).__name__
