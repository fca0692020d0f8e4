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
    return JudgeFigures(
        poses=verdict.poses,
        touching=verdict.capsules.touching,
        deepest=verdict.capsules.deepest,
        least_clearance=None if least is None else least.clearance,
        self_touching=verdict.itself.touching,
        self_deepest=verdict.itself.deepest,
        mesh_touching=None if mesh is None else mesh.touching,
        mesh_deepest=None if mesh is None else mesh.deepest,
        mesh_clearance=None if mesh is None or mesh.least is None else mesh.least.clearance,
    )
