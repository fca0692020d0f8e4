"""A first walk: hold "forward" through the paper's scene C and watch what the upper body does by itself."""

import math

import numpy as np

import elbowroom as er


def main() -> None:
    """Walk to the finish and print a line for every half metre."""
    scene = er.Scene.load("c")
    controller = er.Controller(er.Humanoid.default(), scene, seed=0)
    print(f"{scene.title}: {scene.description}\n")
    print("    z   bend  twist   left arm  right arm   nearest obstacle")

    frame, printed, nearest = controller.step(er.Command(), dt=0.0), -1.0, math.inf
    while not scene.finished(controller.root):
        frame = controller.step(er.Command(forward=1.0), dt=1 / 60)  # one picture of a film
        if frame.stuck:
            raise SystemExit("no way on")
        nearest = min(nearest, frame.clearance)
        if controller.root.z - printed >= 0.5:
            printed = controller.root.z
            bend, twist, _, left, _, _, _, right, *_ = np.degrees(frame.q[3:])
            gap = f"{frame.clearance * 100:5.1f} cm"
            print(f"{printed:5.1f} {bend:5.0f}° {twist:5.0f}° {left:8.0f}° {right:8.0f}°   {gap:>16}")

    print(f"\nThrough after {frame.time:.1f} s. No pose came nearer than {nearest * 1000:.0f} mm to anything.")


if __name__ == "__main__":
    main()
