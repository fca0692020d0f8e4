"""What another library finds in a walk that was shown."""

import numpy as np

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.frame import Frame
from elbowroom.experiment.crossing import DT
from elbowroom.experiment.gauntlet.trial import JudgeFigures
from elbowroom.world.scene import Scene


def judged_walk(humanoid: Humanoid, scene: Scene, shown: list[Frame]) -> JudgeFigures:
    """What another library says about capsules and mesh in all that was shown."""
    from elbowroom.experiment.judge.motion import ShownMotion
    from elbowroom.experiment.judge.verdict import judge

    q, roots = np.stack([frame.q for frame in shown]), np.stack([frame.root for frame in shown])
    verdict = judge(ShownMotion.at_rate(q, roots, 1.0 / DT), humanoid, scene)
    least, mesh = verdict.capsules.least, verdict.mesh
    nearest = None if mesh is None else mesh.least
    return JudgeFigures(
        poses=verdict.poses,
        touching=verdict.capsules.touching,
        deepest=_told(verdict.capsules.deepest),
        least_clearance=None if least is None else _told(least.clearance),
        self_touching=verdict.itself.touching,
        self_deepest=_told(verdict.itself.deepest),
        mesh_touching=None if mesh is None else mesh.touching,
        mesh_deepest=None if mesh is None else _told(mesh.deepest),
        mesh_clearance=None if nearest is None else _told(nearest.clearance),
    )


def _told(metres: float) -> float:
    """To a tenth of a micrometre: farther the library's search for nearest points is not the same in every process."""
    return round(metres, 7)
