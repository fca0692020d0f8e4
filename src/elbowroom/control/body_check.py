"""The last word before a pose is shown: how far the whole body is from every obstacle, and from every other avatar."""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.kinematics import body_model, posture_capsules
from elbowroom.control.neighbour import Neighbour
from elbowroom.planning.halving import begun, due, settle
from elbowroom.planning.model.levers import body_levers
from elbowroom.world.obstacles.moving import Moving
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

_HALVINGS = 7  # of the time between two frames: the bound on a foot in its stride is many times what it moves
_LOOKS = 8  # at once
_BOTH = np.array([0.0, 1.0])  # the frames themselves


def configuration(root: Floats, upper: Floats) -> Floats:
    """The configuration `q` (DOF,) of a root state (7,) and an upper body (LOCAL,)."""
    return np.concatenate([root[:3], upper])


class Frames(NamedTuple):
    """Two frames that are shown one after the other."""

    roots: tuple[Floats, Floats]  # (7,)
    uppers: tuple[Floats, Floats]  # (LOCAL,)
    times: tuple[float, float]  # seconds


class BodyCheck:
    """Clearance of a humanoid's whole collision body in a scene, at a time; what moves stands where it is then."""

    def __init__(self, humanoid: Humanoid, scene: Scene) -> None:
        self.model = body_model(humanoid)  # its joints and capsules, as kernels take them
        self._radii = humanoid.capsules.radii.astype(np.float32)
        self._levers = body_levers(humanoid)
        self._obstacles, moving = scene.obstacles, scene.obstacles.moving
        self._standing = replace(scene.obstacles, moving=Moving()) if len(moving) else scene.obstacles
        self._moving = Obstacles(moving=moving)
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
        """Metres from the nearest obstacle, negative where the body touches, for root (7,) and upper body (LOCAL,).

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

    def free_between(self, frames: Frames, clearances: tuple[float, float]) -> bool:
        """Whether all that a screen shows between two frames is proven free, by `halving`: straight interpolants.

        Where others move as they mean to, until the second frame. `clearances` are those of the frames.
        """
        way, first, last = self._levers.travel(frames.roots, frames.uppers), *frames.times
        ways, gaps = [way], np.array([[clearances[0]], [clearances[1]]], np.float32)
        if self.restless:
            ways += [way + self._moving.moving.fastest * (last - first)]
            ways += [way + other.travel(first, last) for other in self.others]
            gaps = self._gaps(frames, _BOTH)
        proof = begun(gaps, np.array([ways]), 1, 0.0, _HALVINGS)
        parts, shares = np.empty(_LOOKS, np.int64), np.empty(_LOOKS)
        while (count := due(proof, parts, shares)) > 0:
            settle(proof, self._gaps(frames, shares[:count]), count)
        return bool(proof.least.min() >= 0.0)

    def _gaps(self, frames: Frames, shares: Floats) -> Floats32:
        """The clearances at shares (N,) of the time between two frames: from what stands (N, 1).

        Where anything moves by itself, from that too and from each of the others (N, 2 + others).
        """
        (first, last), (begin, end), origin = frames.roots, frames.uppers, frames.roots[0][:2]
        root, upper = first + shares[:, None] * (last - first), begin + shares[:, None] * (end - begin)
        segments = posture_capsules(self.model, np.hstack([root[:, :3], upper]), self._near(root, first))
        gaps = []
        for i, time in enumerate((frames.times[0] + shares * (frames.times[1] - frames.times[0])).tolist()):
            axes = np.ascontiguousarray(segments[:, :, i : i + 1])
            row = [self._standing.clearance(axes, self._radii, origin, time)]
            if self.restless:
                row.append(self._moving.clearance(axes, self._radii, origin, time))
            gaps.append(row + [other.clearance(axes, self._radii, origin, time) for other in self.others])
        return np.array(gaps, np.float32)

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
