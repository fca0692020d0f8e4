"""Eight gestures as configurations: each should look the same on every avatar."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import ARMS, DOF, DofGroup, clamp, followed
from elbowroom.body.root import RootState


@dataclass(frozen=True)
class Gesture:
    """A posture of the upper body and a moment of the walk; angles in degrees, the lowering as a part of its limit."""

    name: str
    arms: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)  # flexion, abduction, internal rotation, elbow
    bend: float = 0.0
    twist: float = 0.0
    lowering: float = 0.0
    root: RootState = field(default_factory=RootState)

    @property
    def q(self) -> NDArray[np.float64]:
        """The configuration (DOF,), within its limits."""
        q = np.zeros(DOF)
        waist = np.append(
            np.deg2rad([self.bend, self.twist]), self.lowering * clamp(DofGroup.WAIST, [0.0, 0.0, 9.0])[2]
        )
        q[DofGroup.WAIST.at] = clamp(DofGroup.WAIST, waist)
        for group in ARMS:
            q[group.at] = clamp(group, np.deg2rad(self.arms))
        first = DofGroup.ROOT.size
        q[first:] = followed(q[first:])
        return q


GESTURES = (
    Gesture("arms up", (170.0, 0.0, 0.0, 0.0)),
    Gesture("T", (0.0, 90.0, 0.0, 0.0)),
    Gesture("hanging"),
    Gesture("fold", (45.0, 0.0, 60.0, 110.0)),
    Gesture("bend", (50.0, 0.0, 0.0, 20.0), bend=60.0),
    Gesture("twist", (30.0, 20.0, 0.0, 60.0), twist=45.0),
    Gesture("duck", (30.0, 10.0, 0.0, 70.0), bend=30.0, lowering=0.8),
    Gesture("stride", (0.0, 8.0, 0.0, 25.0), root=RootState(forward=1.2, phase=0.0)),
)
