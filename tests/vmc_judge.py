"""vmcp, a Virtual Motion Capture receiver of others, in a process of its own: it leaves sockets open behind it.

Call: python vmc_judge.py PORT COUNT; says "ready", listens for so many bones, and prints all that it heard as JSON.
"""

import json
import sys
import time
from typing import Any

from vmcp.events import BoneTransformEvent, Event, RelativeTimeEvent, RootTransformEvent, StateEvent
from vmcp.facades import on_receive
from vmcp.osc import OSC
from vmcp.osc.backend.osc4py3 import as_eventloop

KINDS: tuple[type[Event], ...] = (BoneTransformEvent, RootTransformEvent, StateEvent, RelativeTimeEvent)


def main(port: int, count: int) -> None:
    heard: list[Any] = []
    osc = OSC(as_eventloop)
    with osc.open():
        receiver = osc.create_receiver("127.0.0.1", port, "judge").open()
        for kind in KINDS:
            on_receive(receiver, kind, heard.append)
        print("ready", flush=True)
        while sum(isinstance(event, BoneTransformEvent) for event in heard) < count:
            osc.run()
            time.sleep(0.002)
    print(json.dumps([_told(event) for event in heard]), flush=True)


def _told(event: Any) -> list[Any]:
    """The kind of an event, and for a bone or the root its name, place and rotation."""
    kind = type(event).__name__
    if not isinstance(event, BoneTransformEvent | RootTransformEvent):
        return [kind]
    at, turn = event.position, event.rotation
    name = getattr(event.joint, "value", event.joint)
    return [kind, name, at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w]


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
