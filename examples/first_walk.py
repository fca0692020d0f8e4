"""A first walk: hold "forward" through the paper's scene C and watch what the upper body does by itself."""

import math

import numpy as np

import elbowroom as er


def main() -> None:
    """Walk to the finish and print a line for every half metre."""
    scene, avatar = er.Scene.load("c"), er.Humanoid.default()
    controller = er.Controller(avatar, scene, seed=0)
    print(f"{scene.title}: {scene.description}\n")
    print("    z   bend  twist   left hand, right hand   nearest obstacle")

    frame, printed, nearest = controller.step(er.Command(), dt=0.0), -1.0, math.inf
    while not scene.finished(controller.root):
        frame = controller.step(er.Command(forward=1.0), dt=1 / 60)  # one picture of a film
        if frame.stuck:
            raise SystemExit("no way on")
        nearest = min(nearest, frame.clearance)
        if controller.root.z - printed >= 0.5:
            printed = controller.root.z
            bend, twist = np.degrees(frame.q[3:5])
            pose = frame.pose(avatar)  # rotations of all bones too, for who draws it
            left, right = (pose.joint(hand)[1] for hand in ("leftHand", "rightHand"))  # metres above the ground
            gap = f"{frame.clearance * 100:13.1f} cm"
            print(f"{printed:5.1f} {bend:5.0f}° {twist:5.0f}° {left:9.2f} m {right:9.2f} m {gap}")

    print(f"\nThrough after {frame.time:.1f} s. No pose came nearer than {nearest * 1000:.0f} mm to anything.")


if __name__ == "__main__":
    main()
