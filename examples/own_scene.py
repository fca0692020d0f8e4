"""A scene of one's own, in code: two shelves, a lamp that hangs low, and a trolley that rolls across."""

import json
import math
import sys
from pathlib import Path
from typing import Any

import elbowroom as er

OBSTACLES: list[dict[str, Any]] = [
    {"type": "box", "name": "shelf, left", "center": [0.62, 0.9, 2.0], "size": [0.7, 1.8, 0.4]},
    {"type": "box", "name": "shelf, right", "center": [-0.62, 0.9, 2.9], "size": [0.7, 1.8, 0.4], "yaw": 0.3},
    {"type": "box", "name": "lamp", "center": [0.0, 1.95, 4.2], "size": [2.0, 0.6, 0.2]},
]
TROLLEY = {
    "type": "box",
    "name": "trolley",
    "size": [0.5, 0.9, 0.4],
    "track": [{"center": [-2.5, 0.45, 6.0], "seconds": 5.0}, {"center": [2.5, 0.45, 6.0], "seconds": 5.0}],
    "repeat": "pingpong",
}


def main(file: str | None = None) -> None:
    """Walk through the scene, say when something was near, and keep the scene in `file` for the page."""
    scene = er.Scene.of("attic", OBSTACLES, finish=(0.0, 7.5), moving=[TROLLEY])
    controller = er.Controller(er.Humanoid.default(), scene)
    frame, near = controller.step(er.Command(), dt=0.0), False
    while not scene.finished(controller.root):
        frame = controller.step(er.Command(forward=1.0), dt=1 / 60)
        if frame.stuck:
            sys.exit(f"No way on after {frame.time:.1f} s, at z {controller.root.z:.1f} m")
        if near is not (frame.clearance < 0.1):
            near = not near
            told = f"something is near, {math.degrees(frame.q[3]):.0f}° bent" if near else "free again"
            print(f"{frame.time:4.1f} s, z {controller.root.z:3.1f} m: {told}")
    print(f"Through after {frame.time:.1f} s")
    if file is not None:
        Path(file).write_text(json.dumps(scene.to_dict(), indent=2), "utf-8")
        print(f"look at it: elbowroom play --scene {file}")


if __name__ == "__main__":
    main(*sys.argv[1:2])
