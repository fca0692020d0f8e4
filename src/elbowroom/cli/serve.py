"""`elbowroom serve`: the page for many users, by servers on all nodes of a Ray cluster behind one address."""

import contextlib
import logging
import signal
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from elbowroom.cli.options.arguments import check_arguments
from elbowroom.cli.options.serving import Host, Port
from elbowroom.cli.options.walking import Planner, Queue, SceneName
from elbowroom.cli.options.workers import check_workers
from elbowroom.cli.play import tell_openness
from elbowroom.cli.telling.first_run import compile_first
from elbowroom.cli.telling.spoken import said
from elbowroom.errors import InputError
from elbowroom.planning.names import DEFAULT_PLANNER

if TYPE_CHECKING:
    import asyncio
    import socket

    from elbowroom.cluster.fleet import FleetSettings
    from elbowroom.cluster.replica import ServerOffer

EXAMPLES = "Examples:  elbowroom serve --cluster local  |  elbowroom serve --cluster 10.0.0.5:6379 --host 0.0.0.0"


def serve(
    *,
    cluster: Annotated[
        str, typer.Option(metavar="local|HOST:PORT", help="Ray cluster: one of this machine, or one that runs.")
    ] = "local",
    host: Host = "127.0.0.1",
    port: Port = 8765,
    servers: Annotated[int, typer.Option(min=0, max=64, help="Servers on each node; 0: one for each core.")] = 0,
    scene: SceneName = "a",
    avatar: Annotated[Path | None, typer.Option(help="The avatar that sessions begin with (GLB, VRM).")] = None,
    planner: Planner = DEFAULT_PLANNER,
    queue: Queue = 5,
) -> None:
    """Serve the page to many users, from many machines. Ctrl-C ends it.

    Each session is held by one server; should that be lost, its page goes on at another one, in the same place.
    """
    check_arguments(scenes=[scene], planners=[planner], queues=[queue], files=[avatar], port=port)
    check_workers(cluster)
    from rich.console import Console

    logging.basicConfig(level=logging.WARNING, format="%(levelname)s %(name)s: %(message)s")
    from elbowroom.cluster.fleet import FleetSettings
    from elbowroom.cluster.replica import ServerOffer
    from elbowroom.experiment.gauntlet.scenes import load_scene
    from elbowroom.server.ending import ended_by_signals
    from elbowroom.server.serving import listen
    from elbowroom.server.sessions.walk import WalkSettings

    offer = ServerOffer(load_scene(scene), WalkSettings(planner=planner, queue_size=queue), _read(avatar))
    with contextlib.suppress(KeyboardInterrupt), ended_by_signals(lambda: None), listen(host, port) as opened:
        tell_openness(Console(stderr=True, highlight=False), opened)
        compile_first()
        _serve(cluster, opened, offer, FleetSettings(servers, host))


def _serve(cluster: str, opened: "socket.socket", offer: "ServerOffer", settings: "FleetSettings") -> None:
    import asyncio

    from elbowroom.cluster.connection import joined
    from elbowroom.cluster.fleet import Fleet
    from elbowroom.server.serving import url_of

    def tell(line: str) -> None:
        typer.echo(f"elbowroom: {line}", err=True)

    async def run() -> None:
        fleet = Fleet(nodes, offer, opened, settings, tell)
        serving = asyncio.create_task(fleet.serve())
        ready = asyncio.create_task(fleet.ready.wait())
        loop = asyncio.get_running_loop()
        for sig in (signal.SIGINT, signal.SIGTERM):
            loop.add_signal_handler(sig, _end, sig, serving)
        await asyncio.wait([serving, ready], return_when=asyncio.FIRST_COMPLETED)
        if ready.done():
            typer.echo(said("Elbowroom is at {0}  (Ctrl-C ends it)", url_of(opened)), err=True)
        ready.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await serving

    with joined(cluster, tell) as nodes:
        asyncio.run(run())


def _end(sig: int, serving: "asyncio.Task[None]") -> None:
    """Begin to end; whatever is not ready in a few seconds is not waited for."""
    from elbowroom.server.ending import end_at_latest

    end_at_latest(sig, lambda: None)
    serving.cancel()


def _read(avatar: Path | None) -> tuple[str, bytes] | None:
    """The avatar's file, which travels to all nodes; raises `InputError`."""
    if avatar is None:
        return None
    from elbowroom.body.humanoid import Humanoid

    try:
        data = avatar.read_bytes()
    except OSError as error:
        raise InputError(f"--avatar {avatar}: {error.strerror}") from None
    Humanoid.load(avatar)  # which tells of a damaged one
    return avatar.name, data
