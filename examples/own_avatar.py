"""An avatar of one's own: `python examples/own_avatar.py alice.vrm`; without a file the stock avatar walks."""

import sys

import elbowroom as er


def main(file: str | None = None) -> None:
    """Say what was read, and whether so large a body gets through each of the stock scenes."""
    avatar = er.Humanoid.default() if file is None else er.Humanoid.load(file)
    bones = len(avatar.meta.bones)
    print(
        f"{avatar.name}: {avatar.meta.format}, {bones} bones found, {len(avatar.capsules.radii)} capsules hold its skin"
    )
    for note in avatar.meta.notes:
        print(f"  {note}")

    for name in ("a", "b", "c", "d", "doorway"):
        scene = er.Scene.load(name)
        try:
            controller = er.Controller(avatar, scene)
        except er.InputError as error:  # it has no room at the start
            print(error)
            continue
        frame = controller.step(er.Command(), dt=0.0)
        while not scene.finished(controller.root) and frame.time < 15.0 and not frame.stuck:
            frame = controller.step(er.Command(forward=1.0), dt=1 / 60)
        outcome = "no way on" if frame.stuck else "through" if scene.finished(controller.root) else "still walking"
        print(f"scene {name:8} {outcome} after {frame.time:4.1f} s, {controller.root.z:.1f} m on")


if __name__ == "__main__":
    main(*sys.argv[1:2])
