"""Tasks done by the nodes of a cluster."""

import pickle
from collections import Counter, deque
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple, TypeVar

import ray

from elbowroom.cluster.node import Node
from elbowroom.cluster.nodes import Nodes, remote
from elbowroom.errors import InputError
from elbowroom.experiment.opened import Openable, bring, is_held, opened
from elbowroom.experiment.parallel import Task

Result = TypeVar("Result")

_AHEAD = 2  # tasks that a node has for each of its cores: it never waits for the next one
_MOST_LOSSES = 3  # of one task: then it is the task that ends its workers
_PATIENCE = 1.0  # seconds of waiting for results before nodes are looked at again


class _Sent(NamedTuple):
    place: int  # index of the task
    node: str


class RayWorkers:
    """The nodes of the cluster that this process is connected to, see `connection.connected`.

    Each node gets at most twice as many tasks as it has cores, whatever the number of tasks. A task whose worker or
    node was lost is done again; Ray repeats nothing by itself, so each result is given once.
    """

    def __init__(self, nodes: Nodes) -> None:
        self._nodes = nodes
        self._kept: dict[Openable[Any], Any] = {}  # what tasks ask for, as it lies in the cluster's memory

    @property
    def at_once(self) -> int:
        """How many tasks are done at the same time, as far as nodes are ready."""
        return sum(node.cores for node in self._nodes.ready)

    def run(self, tasks: Sequence[Task[Result]]) -> Iterator[tuple[int, Result]]:
        """See `Workers`; raises `InputError` when no node is left, and for a task that ends each of its workers."""
        waiting, sent, losses = deque(range(len(tasks))), dict[Any, _Sent](), Counter[int]()
        try:
            while waiting or sent:
                self._nodes.look() if sent else self._nodes.wait()
                self._hand_out(tasks, waiting, sent)
                for reference in ray.wait(list(sent), timeout=_PATIENCE)[0]:
                    place, node = sent.pop(reference)
                    try:
                        yield place, ray.get(reference)
                    except ray.exceptions.RayTaskError as error:
                        raise error.cause from None
                    except (ray.exceptions.WorkerCrashedError, ray.exceptions.OutOfMemoryError) as error:
                        losses[place] += 1
                        _check_losses(losses[place], error)
                        waiting.appendleft(place)
                    except ray.exceptions.RayError:
                        self._nodes.lose(node)
                        waiting.appendleft(place)
        finally:
            for reference in sent:
                ray.cancel(reference, force=True)

    def _hand_out(self, tasks: Sequence[Task[Result]], waiting: deque[int], sent: dict[Any, _Sent]) -> None:
        """Give every node as many tasks as it may have, by turns."""
        having = Counter(one.node for one in sent.values())
        ready = self._nodes.ready
        for fill in range(1, _AHEAD * max((node.cores for node in ready), default=0) + 1):
            for node in ready:
                if waiting and having[node.name] < min(fill, _AHEAD * node.cores):
                    place = waiting.popleft()
                    sent[self._send(tasks[place], node)] = _Sent(place, node.name)
                    having[node.name] += 1

    def _send(self, task: Task[Any], node: Node) -> Any:
        for thing in task.things:
            if thing not in self._kept:
                self._kept[thing] = ray.put(pickle.dumps(opened(thing)))
        return remote(_do, node).remote(task, [self._kept[thing] for thing in task.things])


def _do(task: Task[Result], kept: list[Any]) -> Result:
    """Runs on a node: the task, with the things that it asks for, taken from the cluster's memory once in a process.

    They lie there pickled: arrays that Ray itself gives are read-only, which is another type to the kernels.
    """
    for thing, reference in zip(task.things, kept, strict=True):
        if not is_held(thing):
            bring(thing, pickle.loads(ray.get(reference)))
    return task.run()


def _check_losses(losses: int, error: Exception) -> None:
    if losses >= _MOST_LOSSES:
        kind = type(error).__name__
        raise InputError(f"a task ended its worker {losses} times ({kind}; out of memory?); what is done is kept")
