"""Servers on the nodes of a real cluster: one dies, a node is taken away, and users go on."""

import asyncio
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

ray = pytest.importorskip("ray", reason="needs Ray: pip install 'elbowroom[cluster]'")

from websockets.exceptions import ConnectionClosed, WebSocketException  # noqa: E402

from elbowroom.cluster.connection import joined  # noqa: E402
from elbowroom.cluster.fleet import Fleet, FleetSettings  # noqa: E402
from elbowroom.cluster.keeper import Keeper  # noqa: E402
from elbowroom.cluster.replica import ServerOffer  # noqa: E402
from elbowroom.server.schema.commands import Configure  # noqa: E402
from elbowroom.server.schema.menus import Settings  # noqa: E402
from elbowroom.server.schema.picture import SceneMessage  # noqa: E402
from elbowroom.server.schema.progress import Status  # noqa: E402
from elbowroom.server.serving import listen, url_of  # noqa: E402
from elbowroom.server.sessions.walk import WalkSettings  # noqa: E402
from elbowroom.server.wire.pose_frame import PoseFrame  # noqa: E402
from elbowroom.world.scene import Scene  # noqa: E402
from live_session import LONG, Client, client_at  # noqa: E402

NODE: dict[str, Any] = {"num_cpus": 1, "object_store_memory": 100 * 2**20}
KEY = "9" * 32


def test_the_keeper_keeps_no_more_than_it_may() -> None:
    now = 0.0
    keeper = Keeper(10, lambda: now)
    keeper.put("a", b"12345")
    keeper.put("b", b"12345")
    assert keeper.get("a") == b"12345"
    keeper.put("c", b"1")
    assert [keeper.get(name) for name in "abc"] == [b"12345", None, b"1"]
    keeper.put("user:x", b"1")
    now = 601.0
    assert (keeper.get("user:x"), keeper.get("a")) == (None, b"12345")


@contextmanager
def serving(fleet: Fleet, loop: asyncio.AbstractEventLoop) -> Iterator[None]:
    task = loop.create_task(fleet.serve())

    def run() -> None:
        with pytest.raises(asyncio.CancelledError):
            loop.run_until_complete(task)
        loop.close()

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    try:
        yield
    finally:
        loop.call_soon_threadsafe(task.cancel)
        thread.join(LONG)


def wait_until(true: Any) -> None:
    end = time.monotonic() + LONG
    while not true():
        assert time.monotonic() < end
        time.sleep(0.1)


def walk_and_stand(client: Client) -> PoseFrame:
    start = client.frame()
    client.press(forward=1.0)
    client.frame(lambda f: f.z - start.z > 0.5)
    client.press()
    still = client.frame(lambda f: f.forward == 0.0)
    client.wait_for(Status, lambda status: status.time > still.time + 1.0)
    return client.frame()


@contextmanager
def back(url: str) -> Iterator[Client]:
    """The page, as it comes again and again until it is let in."""
    end = time.monotonic() + LONG
    while True:
        try:
            with client_at(f"{url}/ws?key={KEY}") as client:
                client.wait_for(Settings)
                yield client
                return
        except (OSError, WebSocketException):
            assert time.monotonic() < end
            time.sleep(0.25)


@pytest.mark.long
def test_who_loses_a_server_or_a_node_goes_on_in_the_same_place(monkeypatch: pytest.MonkeyPatch) -> None:
    from ray.cluster_utils import Cluster

    monkeypatch.setenv("RAY_USAGE_STATS_ENABLED", "0")
    monkeypatch.setenv("RAY_worker_niceness", "0")
    cluster: Any = Cluster(initialize_head=True, head_node_args=NODE | {"include_dashboard": False})
    other = cluster.add_node(**NODE)
    told: list[str] = []
    loop = asyncio.new_event_loop()
    offer, settings = ServerOffer(Scene.load("empty"), WalkSettings()), FleetSettings(each=1)
    with joined(cluster.address, told.append) as nodes, listen("127.0.0.1", 0) as opened:
        fleet = Fleet(nodes, offer, opened, settings, told.append)
        url = url_of(opened)
        with serving(fleet, loop):
            wait_until(lambda: len(fleet.replicas) == 2)
            with back(url) as client:
                client.send(Configure(scene="a"))
                client.wait_for(SceneMessage, lambda scene: scene.name == "a")
                last = walk_and_stand(client)
                ray.kill(fleet.replicas[place_of_session(fleet)])
                with pytest.raises(ConnectionClosed):
                    client.wait_for(PoseFrame, lambda _: False)
            with back(url) as client:
                stands(client, last)
                wait_until(lambda: len(fleet.replicas) == 2)  # another one was started
                harmed = place_of_session(fleet)[0] == other.node_id
                cluster.remove_node(other)
                wait_until(lambda: len(fleet.replicas) == 1)
                if not harmed:
                    stands(client, last)
                else:
                    with pytest.raises(ConnectionClosed):
                        client.wait_for(PoseFrame, lambda _: False)
            if harmed:
                with back(url) as client:
                    stands(client, last)
    cluster.shutdown()
    assert any("is gone" in line for line in told)


def place_of_session(fleet: Fleet) -> tuple[str, int]:
    led = fleet.door.choose(KEY, begins_session=False)
    return next(place for place, replica in fleet.replicas.items() if ray.get(replica.address.remote()) == led)


def stands(client: Client, last: PoseFrame) -> None:
    frame = client.frame()
    assert (frame.x, frame.z) == pytest.approx((last.x, last.z), abs=0.05)
