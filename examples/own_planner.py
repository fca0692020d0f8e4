"""A planner of one's own, by name: it tries a few gestures in turn and takes the first that stays clear."""

import numpy as np
from numpy.typing import NDArray

import elbowroom as er

Floats = NDArray[np.float64]

# Waist: bend, twist, lowering. Each arm: flexion, abduction, rotation of the shoulder; elbow. Head: nod, turn. Degrees.
WAISTS, FOLDED, AHEAD = ([0, 0, 0], [0, 40, 0], [0, -40, 0], [25, 0, 0], [55, 0, 0]), [35, -5, 60, 125], [0, 0]
GESTURES = np.radians([waist + FOLDED + FOLDED + AHEAD for waist in WAISTS])


class Gestures:
    """Walks naturally while that is clear; else folds the arms and turns or bends as little as helps."""

    def __init__(self, humanoid: er.Humanoid, scene: er.Scene, **_: object) -> None:
        self.check = er.BodyCheck(humanoid, scene)

    def reset(self) -> None:
        """It remembers nothing."""

    def plan(self, path: er.RootPath, start: Floats, rng: np.random.Generator) -> er.LocalPlan:
        """Towards the natural walk, or towards one of the gestures: whichever is clear first."""
        natural = er.natural_walk()(path)
        for goals in (natural, *(np.broadcast_to(gesture, natural.shape) for gesture in GESTURES)):
            motion = [start]
            for goal in goals[1:]:
                motion.append(motion[-1] + np.clip(goal - motion[-1], -0.4, 0.4))  # radians in a key interval
            if self.is_clear(path, np.array(motion)):
                return er.LocalPlan(er.PlanStatus.FOUND, np.array(motion), natural, ())
        return er.LocalPlan(er.PlanStatus.EXHAUSTED, np.empty((0, len(start))), natural, ())

    def is_clear(self, path: er.RootPath, motion: Floats) -> bool:
        """Whether the whole body keeps 1 cm of margin at three moments of every key interval."""
        times = np.linspace(path.times[0], path.times[-1], 3 * path.horizon + 1)
        uppers = np.transpose([np.interp(times, path.times, column) for column in motion.T])
        poses = list(zip(path.sample(times), uppers, times, strict=True))
        return all(self.check.clearance(root, upper, time) >= 0.01 for root, upper, time in poses[1:])


def main() -> None:
    """Register it, and set it beside the planner that comes with the package."""
    er.register_planner("gestures", Gestures)
    for scene in map(er.Scene.load, ("c", "beam")):
        for planner in ("gestures", "exact"):
            controller = er.Controller(er.Humanoid.default(), scene, planner=planner)
            for _ in range(60 * 60):  # frames: a minute at most
                if controller.step(er.Command(forward=1.0), dt=1 / 60).stuck or scene.finished(controller.root):
                    break
            outcome = "through" if scene.finished(controller.root) else "stuck"
            print(f"{scene.name:5} {planner:9} {outcome} at z = {controller.root.z:.1f} m")


if __name__ == "__main__":
    main()
