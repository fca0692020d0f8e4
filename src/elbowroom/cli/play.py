"""`elbowroom play`: the page, and the server behind it."""

import contextlib
import logging
import os
import sys
import threading
import webbrowser
from dataclasses import replace
from typing import TYPE_CHECKING

from elbowroom.cli.options import clips as clip_options
from elbowroom.cli.options import vmc as vmc_options
from elbowroom.cli.options.arguments import check_arguments
from elbowroom.cli.options.avatar import Avatar, Bones, Height, IncludeHair, settings_by
from elbowroom.cli.options.place import Drop, GroundHeight, Passable, Scale, is_model, open_scene, place_options
from elbowroom.cli.options.serving import Host, OpenPage, Port
from elbowroom.cli.options.vmc import check_vmc, stream_to
from elbowroom.cli.options.walking import Planner, Queue, SceneName
from elbowroom.cli.telling.first_run import compile_first
from elbowroom.cli.telling.spoken import said
from elbowroom.clips.style_names import PLAIN_NAME
from elbowroom.planning.names import DEFAULT_PLANNER

if TYPE_CHECKING:
    import socket
    from collections.abc import Callable

    from rich.console import Console

    from elbowroom.server.stores.library import Library

_OPEN = (
    "Warning: listening on {0}. Everyone who can reach this machine over the network can open the page, load avatars "
    "into this server and use its processor; there is no password."
)
EXAMPLES = "Examples:  elbowroom play --scene d  |  elbowroom play --avatar alice.vrm --port 9000 --no-open"


def play(
    *,
    host: Host = "127.0.0.1",
    port: Port = 8765,
    open_page: OpenPage = True,
    scene: SceneName = "a",
    avatar: Avatar = None,
    bones: Bones = None,
    height: Height = None,
    include_hair: IncludeHair = False,
    planner: Planner = DEFAULT_PLANNER,
    queue: Queue = 5,
    scale: Scale = None,
    ground: GroundHeight = None,
    drop: Drop = None,
    passable: Passable = None,
    style: clip_options.StyleName = PLAIN_NAME,
    swing: clip_options.Swing = None,
    dodge: clip_options.Dodge = None,
    unit: clip_options.Unit = None,
    up: clip_options.Up = None,
    fps: clip_options.Fps = None,
    vmc: vmc_options.Vmc = None,
    vmc_root: vmc_options.VmcRoot = "root",
    vmc_bundles: vmc_options.VmcBundles = True,
) -> None:
    """Walk an avatar through a scene in the browser. Ctrl-C ends it."""
    check_arguments(scenes=[scene], planners=[planner], queues=[queue], files=[avatar, bones], port=port)
    check_arguments(clips=clip_options.named_by(swing, dodge))
    check_vmc(vmc, vmc_root)
    read, of_place = settings_by(bones, height, include_hair), is_model(scene)
    of_clips = clip_options.told_by(unit, None if of_place else up, fps)
    told = place_options(scale, up if of_place else None, ground, drop, passable)
    from elbowroom.server.sessions.walk import WalkSettings
    from elbowroom.server.stores.library import Library

    settings = WalkSettings(planner=planner, queue_size=queue).in_style(style)
    motions = clip_options.motions_by(swing, dodge, of_clips)

    with stream_to(vmc, vmc_root, bundles=vmc_bundles) or contextlib.nullcontext() as stream:

        def library() -> Library:
            shown = open_scene(scene, told, quiet=False)
            return replace(Library.open(shown, avatar, settings, motions, read), vmc=stream)

        serve_until_interrupted(library, host, port, open_page=open_page)


def serve_until_interrupted(
    make: "Callable[[], Library]", host: str, port: int, *, open_page: bool, query: str = ""
) -> None:
    """Serve the page with a library until Ctrl-C; raises `InputError` where there is no such library or port.

    The page opens with `query` in its address.
    """
    from rich.console import Console

    from elbowroom.server.ending import ended_by_signals
    from elbowroom.server.heap import share_one_heap
    from elbowroom.server.kernels.warmup import first_steps
    from elbowroom.server.serving import listen, serve, url_of
    from elbowroom.server.sessions.planning_thread import let_frames_go_first

    share_one_heap()
    let_frames_go_first()
    console = Console(stderr=True, highlight=False)
    logging.basicConfig(level=logging.WARNING, format="%(levelname)s %(name)s: %(message)s")
    with (
        contextlib.suppress(KeyboardInterrupt),
        contextlib.ExitStack() as stack,
        ended_by_signals(stack.close),
        listen(host, port) as opened,
    ):
        library = stack.enter_context(contextlib.closing(make()))
        compile_first()
        first_steps(library)
        _tell_port(console, opened, port)
        tell_openness(console, opened)
        serve(
            library, opened, host, lambda: _ready(library, url_of(opened) + (f"/?{query}" if query else ""), open_page)
        )
    console.print(said("Stopped."))


def _tell_port(console: "Console", opened: "socket.socket", wanted: int) -> None:
    found = opened.getsockname()[1]
    if wanted not in (0, found):
        console.print(f"[yellow]{said('Port {0} is busy; using {1} instead.', wanted, found)}[/yellow]")


def tell_openness(console: "Console", opened: "socket.socket") -> None:
    """Warn of who can come in, where that is more than this machine."""
    from elbowroom.server.entrance.guard import is_loopback

    address = opened.getsockname()[0]
    if not is_loopback(address):
        console.print(f"[yellow]{said(_OPEN, address)}[/yellow]")


def _ready(library: "Library", url: str, open_page: bool) -> None:
    from elbowroom.server.heap import settle
    from elbowroom.server.kernels.warmup import warm_up

    def load_the_rest() -> None:  # while the page opens
        warm_up(library)
        settle()

    threading.Thread(target=load_the_rest, daemon=True).start()
    print(said("Elbowroom is at {0}  (Ctrl-C ends it)", url), flush=True)
    if open_page and _has_display():
        threading.Thread(target=webbrowser.open, args=(url,), daemon=True).start()


def _has_display() -> bool:
    if sys.platform in ("darwin", "win32"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
