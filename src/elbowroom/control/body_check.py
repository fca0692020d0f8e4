"""The last word before a pose is shown: how far the whole body is from every obstacle, and from every other avatar."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.kinematics import body_model, posture_capsules
from elbowroom.control.neighbour import Neighbour
from elbowroom.world.obstacles.moving import Moving
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

_BETWEEN = np.array([0.25, 0.5, 0.75])  # at 60 frames a second: 240 poses
_UNTIL = np.append(_BETWEEN, 1.0)


def configuration(root: Floats, upper: Floats) -> Floats:
    """The configuration `q` (14,) of a root state (7,) and an upper body (11,)."""
    return np.concatenate([root[:3], upper])


class BodyCheck:
    """Clearance of a humanoid's whole collision body in a scene, at a time; what moves stands where it is then."""

    def __init__(self, humanoid: Humanoid, scene: Scene) -> None:
        self.model = body_model(humanoid)  # its joints and capsules, as kernels take them
        self._radii = humanoid.capsules.radii.astype(np.float32)
        self._obstacles = scene.obstacles
        self._empty = not len(scene.obstacles.shapes) and not len(scene.obstacles.moving)
        self.others: Sequence[Neighbour] = ()  # other avatars, as they say that they will move

    @property
    def alone(self) -> bool:
        """Whether there is nothing and nobody else: then no pose has to be looked at."""
        return self._empty and not self.others

    @property
    def restless(self) -> bool:
        """Whether anything moves by itself."""
        return bool(len(self._obstacles.moving) or self.others)

    def clearance(self, root: Floats, upper: Floats, time: float) -> float:
        """Metres from the nearest obstacle, negative where the body touches, for root (7,) and upper body (11,).

        The avatar is put at the origin and the obstacles move instead, so that single precision holds anywhere.
        """
        return np.inf if self.alone else self._least(self._posed(root, upper), root, time)

    def body(self, root: Floats, upper: Floats) -> Floats:
        """The ends of the capsules as seen from the root's place, and their radii, (C, 7) metres."""
        return np.column_stack([self._posed(root, upper)[:, :, 0], self._radii]).astype(np.float64)

    def shown_clearance(self, root: Floats, upper: Floats, time: float) -> float:
        """The same while others still are as they were shown last: what they mean to do next is for them to answer."""
        return np.inf if self.alone else self._least(self._posed(root, upper), root, time, others_at=-np.inf)

    def clearance_from(self, moving: Moving, root: Floats, upper: Floats, time: float) -> float:
        """The same from some moving obstacles alone."""
        segments = self._posed(root, upper)
        return Obstacles(moving=moving).clearance(segments, self._radii, root[:2], time)

    def clearance_between(
        self, roots: tuple[Floats, Floats], uppers: tuple[Floats, Floats], times: tuple[float, float]
    ) -> float:
        """The least clearance, metres, of the poses that a screen shows between two frames: straight interpolants.

        Where others move as they mean to, until the second frame.
        """
        looks = _UNTIL if self.others else _BETWEEN
        root = roots[0] + looks[:, None] * (roots[1] - roots[0])
        upper = uppers[0] + looks[:, None] * (uppers[1] - uppers[0])
        segments = posture_capsules(self.model, np.hstack([root[:, :3], upper]), self._near(root, roots[0]))
        if not self.restless:
            return self._obstacles.clearance(segments, self._radii, roots[0][:2], times[0])
        moments = times[0] + looks * (times[1] - times[0])
        return min(self._least(segments[:, :, i : i + 1], roots[0], float(time)) for i, time in enumerate(moments))

    def _posed(self, root: Floats, upper: Floats) -> Floats32:
        """The capsules' axes (C, 6, 1) as seen from the root."""
        return posture_capsules(self.model, configuration(root, upper)[None], self._near(root, root)[None])

    def _least(self, segments: Floats32, origin: Floats, time: float, others_at: float | None = None) -> float:
        """The least clearance of one posture (C, 6, 1) as seen from `origin`, at a time."""
        found = self._obstacles.clearance(segments, self._radii, origin[:2], time)
        axes, when = np.ascontiguousarray(segments), time if others_at is None else others_at
        return min([found, *(other.clearance(axes, self._radii, origin, when) for other in self.others)])

    def _near(self, roots: Floats, origin: Floats) -> Floats:
        near = roots.copy()
        near[..., :2] -= origin[:2]
        return near
