"""Servers on all nodes of a cluster behind one door: started, watched, and started again where one is lost."""

import asyncio
import contextlib
import pickle
import secrets
import socket
import time
from dataclasses import dataclass
from typing import Any

import ray
from ray.util.scheduling_strategies import NodeAffinitySchedulingStrategy

from elbowroom.cluster.door import Door
from elbowroom.cluster.keeper import Keeper
from elbowroom.cluster.node import Node
from elbowroom.cluster.nodes import Nodes, Tell
from elbowroom.cluster.replica import Replica, ServerOffer
from elbowroom.server.serving import Front

_LOOK_EVERY = 1.0  # seconds between two looks at the nodes
_AGAIN = 2.0  # seconds until the next try where a server ended at once
_ANY = ("0.0.0.0", "::")  # addresses of all networks
_END_IN = 4.0  # seconds


@dataclass(frozen=True)
class FleetSettings:
    """How the servers are laid out."""

    each: int = 0  # servers on a node; 0: one for each of its cores
    name: str = ""  # of the host, as it was asked for


class Fleet:
    """Lives in one event loop of the process that has the door."""

    def __init__(
        self, nodes: Nodes, offer: ServerOffer, opened: socket.socket, settings: FleetSettings, tell: Tell
    ) -> None:
        """`opened` is where the door listens; `tell` hears in one line of each server that comes or is lost."""
        self._nodes, self._opened, self._tell, self._settings = nodes, opened, tell, settings
        self._word = secrets.token_hex(16)
        self.door = Door(self._word)
        self._offer = ray.put(pickle.dumps(offer))  # arrays that Ray gives are read-only: another type to kernels
        self._keeper = ray.remote(Keeper).options(num_cpus=0).remote()
        self.ready = asyncio.Event()  # set when the first server is there
        self.replicas: dict[tuple[str, int], Any] = {}  # by node and number there

    async def serve(self) -> None:
        """Serve until cancelled."""
        tasks: dict[tuple[str, int], asyncio.Task[None]] = {}
        door = asyncio.create_task(self.door.serve(self._opened))
        try:
            while not door.done():
                await asyncio.to_thread(self._nodes.look)
                for place, node in self._places().items():
                    if place not in tasks or tasks[place].done():
                        tasks[place] = asyncio.create_task(self._keep(place, node))
                await asyncio.wait([door], timeout=_LOOK_EVERY)
            await door
        finally:
            await self._end([door, *tasks.values()])

    def _places(self) -> dict[tuple[str, int], Node]:
        return {
            (node.name, number): node
            for node in self._nodes.ready
            for number in range(self._settings.each or node.cores)
        }

    async def _keep(self, place: tuple[str, int], node: Node) -> None:
        """Have a server at a place on a node, until it is lost."""
        began, address = time.monotonic(), None
        replica = self._made(node)
        try:
            address = await _answer(replica.address.remote())
            self.replicas[place] = replica
            self.door.add(address)
            self.ready.set()
            self._tell(f"a server is ready on node {node.address}")
            await _answer(replica.ended.remote())
        except ray.exceptions.RayError as error:
            self._tell(f"a server on node {node.address} is gone; its users go on at others ({type(error).__name__})")
        finally:
            self.replicas.pop(place, None)
            if address is not None:
                self.door.remove(address)
        if time.monotonic() - began < _AGAIN:
            await asyncio.sleep(_AGAIN)

    def _made(self, node: Node) -> Any:
        host, each = self._opened.getsockname()[0], self._settings.each or node.cores
        name = socket.gethostname() if host in _ANY else self._settings.name  # the servers' machines have other names
        front = Front(self._word, host, name, 1.0 / each)
        there = NodeAffinitySchedulingStrategy(node.name, soft=False)
        actor = ray.remote(Replica).options(
            num_cpus=min(node.cores / each, 1.0), scheduling_strategy=there, max_concurrency=4
        )
        return actor.remote(self._offer, front, self._keeper)

    async def _end(self, tasks: "list[asyncio.Task[None]]") -> None:
        """Close the door, and end all servers."""
        for task in tasks:
            task.cancel()
        ending = [_answer(replica.end.remote()) for replica in self.replicas.values()]
        await asyncio.gather(*tasks, return_exceptions=True)
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(_END_IN):
                await asyncio.gather(*ending, return_exceptions=True)


async def _answer(reference: Any) -> Any:
    return await asyncio.wrap_future(reference.future())
