"""One server of many, on a node of the cluster: the whole application, with a shelf that it shares with the others."""

import pickle
import threading
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import ray

from elbowroom.cluster.door import Address
from elbowroom.cluster.keeper import SharedShelf
from elbowroom.server.heap import settle, share_one_heap
from elbowroom.server.kernels.warmup import first_steps, warm_up
from elbowroom.server.serving import Front, listen, make_server
from elbowroom.server.sessions.planning_thread import give_way, let_frames_go_first
from elbowroom.server.sessions.walk import WalkSettings
from elbowroom.server.stores.library import Library, planning_threads
from elbowroom.world.scene import Scene

_ENDS_IN = 3.0  # seconds


@dataclass(frozen=True)
class ServerOffer:
    """What all servers begin with."""

    scene: Scene
    walk: WalkSettings
    avatar: tuple[str, bytes] | None = None  # name of the file, and what it holds


class Replica:
    """Runs on a node, as an actor."""

    def __init__(self, offer: bytes, front: Front, keeper: Any) -> None:
        """`offer` is a `ServerOffer`, pickled; all kernels are loaded when this returns."""
        share_one_heap()
        let_frames_go_first()
        opened = _opened(pickle.loads(offer))
        self._library = replace(opened, planning=planning_threads(give_way), shelf=SharedShelf(keeper), shared=True)
        first_steps(self._library)
        self._socket = listen(str(ray.util.get_node_ip_address()), 0)  # type: ignore[no-untyped-call]
        self._server = make_server(self._library, self._socket, front=front)
        self._thread = threading.Thread(target=self._server.run, kwargs={"sockets": [self._socket]}, daemon=True)
        self._thread.start()
        warm_up(self._library)
        settle()

    def address(self) -> Address:
        """Where it listens."""
        return Address(*self._socket.getsockname()[:2])

    def ended(self) -> None:
        """Returns when it serves no more; a caller hears of its death, too."""
        self._thread.join()

    def end(self) -> None:
        """Take nobody in any more, close all sessions so that they go on elsewhere, and end."""
        self._server.drain()
        self._thread.join(_ENDS_IN)
        self._library.close()


def _opened(offer: ServerOffer) -> Library:
    if offer.avatar is None:
        return Library.open(offer.scene, None, offer.walk)
    name, data = offer.avatar
    with TemporaryDirectory() as folder:
        file = Path(folder, Path(name).name)
        file.write_bytes(data)
        return Library.open(offer.scene, file, offer.walk)
