"""The options by which commands send what they show to a Virtual Motion Capture receiver."""

import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from elbowroom.body.humanoid import Humanoid
    from elbowroom.control.frame import Frame
    from elbowroom.server.vmc.stream import VmcStream

Vmc = Annotated[str | None, typer.Option("--vmc", help="Send the motion by VMC to HOST:PORT.", metavar="HOST:PORT")]
VmcRoot = Annotated[str, typer.Option("--vmc-root", help="What carries the way there: root, or hips.")]
VmcBundles = Annotated[
    bool, typer.Option("--vmc-bundles/--no-vmc-bundles", help="All of a frame in one bundle; off: message by message.")
]


def check_vmc(address: str | None, root: str) -> None:
    """Raises `InputError` for options that mean nothing, before anything else is done."""
    from elbowroom.server.vmc.settings import Locomotion, VmcSettings

    Locomotion.named(root)
    if address is not None:
        VmcSettings.parse(address, root)


def stream_to(address: str | None, root: str, *, bundles: bool) -> "VmcStream | None":
    """The stream that the options ask for; raises `InputError`."""
    if address is None:
        return None
    from elbowroom.server.vmc.settings import VmcSettings
    from elbowroom.server.vmc.stream import VmcStream

    return VmcStream(VmcSettings.parse(address, root, bundles=bundles))


def in_time(stream: "VmcStream", humanoid: "Humanoid") -> "Callable[[Frame], None]":
    """What sends each frame when its time has come by the clock."""
    from elbowroom.server.vmc.protocol import VmcMoment
    from elbowroom.server.wire.pose import Poser

    poser, began = Poser(humanoid), time.monotonic()

    def send(frame: "Frame") -> None:
        time.sleep(max(began + frame.time - time.monotonic(), 0.0))
        x, z, heading = frame.root[:3].tolist()
        stream.show(stream, humanoid, VmcMoment(frame.time, (x, 0.0, z), heading, poser.node_pose(frame.q, frame.root)))

    return send
