"""Two avatars: each is told what the other means to do, and they pass each other in a corridor."""

import math

import elbowroom as er

WALLS = [
    {"type": "box", "name": "wall, left", "center": [1.2, 1.2, 3.0], "size": [0.2, 2.4, 8.0]},
    {"type": "box", "name": "wall, right", "center": [-1.2, 1.2, 3.0], "size": [0.2, 2.4, 8.0]},
]


def main() -> None:
    """Let them meet head on and print how far they are from each other, twice a second."""
    scene, avatar = er.Scene.of("corridor", WALLS, finish=(0.0, 6.0)), er.Humanoid.default()
    one = er.Controller(avatar, scene, start=er.RootState(0.0, 0.0, heading=0.0))
    two = er.Controller(avatar, scene, start=er.RootState(0.0, 6.0, heading=math.pi))
    frames = 0
    while one.root.z < 5.0 or two.root.z > 1.0:
        one.others, two.others = (two.prediction(),), (one.prediction(),)
        seen = [walker.step(er.Command(forward=1.0), dt=1 / 60) for walker in (one, two)]
        if any(frame.touching for frame in seen) or seen[0].time > 20.0:
            raise SystemExit(f"they are stuck after {seen[0].time:.1f} s")
        if frames % 30 == 0:
            apart = math.hypot(one.root.x - two.root.x, one.root.z - two.root.z)
            print(f"{seen[0].time:4.1f} s  {apart:4.2f} m apart  {'>' * int(10 * apart)}")
        frames += 1
    print(f"Both are through after {seen[0].time:.1f} s.")


if __name__ == "__main__":
    main()
