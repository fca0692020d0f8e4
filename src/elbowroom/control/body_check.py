"""The last word before a pose is shown: how far the whole body is from every obstacle, and from every other avatar."""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOWERING
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.kinematics import body_model, posture_capsules
from elbowroom.control.neighbour import Neighbour
from elbowroom.planning.halving import begun, due, settle
from elbowroom.planning.model.footing import Footing
from elbowroom.planning.model.levers import body_levers
from elbowroom.world.obstacles.moving import Moving
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

_HALVINGS = 9  # of the time between two frames: the bound on a foot in its stride is many times what it moves
_LOOKS = 8  # at once
THING_MARGIN = 0.03  # metres that stay between the body that is shown and what is pushed towards it
_BOTH = np.array([0.0, 1.0])  # the frames themselves


def configuration(root: Floats, upper: Floats) -> Floats:
    """The configuration `q` (DOF,) of a root state (7,) and an upper body (LOCAL,)."""
    return np.concatenate([root[:3], upper])


class Frames(NamedTuple):
    """Two frames that are shown one after the other."""

    roots: tuple[Floats, Floats]  # (WITH_FEET,)
    uppers: tuple[Floats, Floats]  # (LOCAL,)
    times: tuple[float, float]  # seconds


class BodyCheck:
    """Clearance of a humanoid's whole collision body in a scene, at a time; what moves stands where it is then."""

    def __init__(self, humanoid: Humanoid, scene: Scene) -> None:
        self.model = body_model(humanoid)  # its joints and capsules, as kernels take them
        self._radii = humanoid.capsules.radii.astype(np.float32)
        self._footing = Footing(self.model, scene.ground)
        self._levers = body_levers(humanoid)
        self._obstacles, moving = scene.obstacles, scene.obstacles.moving
        self._standing = replace(scene.obstacles, moving=Moving()) if len(moving) else scene.obstacles
        self._moving = Obstacles(moving=moving)
        self._empty = not len(scene.obstacles.shapes) and not len(scene.obstacles.moving)
        self.others: Sequence[Neighbour] = ()  # other avatars, as they say that they will move
        self._loose = Obstacles()

    @property
    def alone(self) -> bool:
        """Whether there is nothing and nobody else: then no pose has to be looked at."""
        return self._empty and not self.others and not len(self._loose)

    @property
    def loose(self) -> Moving:
        """What was taken in hand, as it moves from the frame that is shown to the next."""
        return self._loose.moving

    @loose.setter
    def loose(self, things: Moving) -> None:
        self._loose = Obstacles(moving=things)

    @property
    def restless(self) -> bool:
        """Whether anything moves that is not the avatar's own."""
        return bool(len(self._obstacles.moving) or self.others) or self.loose.fastest > 0.0

    def clearance(self, root: Floats, upper: Floats, time: float) -> float:
        """Metres from the nearest obstacle, negative where the body touches, for root (7,) and upper body (LOCAL,).

        The root may be followed by its feet, here and below.

        The avatar is put at the origin and the obstacles move instead, so that single precision holds anywhere.
        """
        return np.inf if self.alone else self._least(self._posed(root, upper), root, time)

    def body(self, root: Floats, upper: Floats) -> Floats:
        """The ends of the capsules as seen from the root's place, and their radii, (C, 7) metres."""
        return np.column_stack([self._posed(root, upper)[:, :, 0], self._radii]).astype(np.float64)

    def room_of_legs(self, root: Floats, upper: Floats, time: float) -> float:
        """Metres from the legs to the nearest obstacle, as `shown_clearance` of the whole body."""
        if self.alone:
            return np.inf
        legs = self.model.roots.indices
        return self._least(self._posed(root, upper)[legs], root, time, others_at=-np.inf, radii=self._radii[legs])

    def shown_clearance(self, root: Floats, upper: Floats, time: float) -> float:
        """The same while others still are as they were shown last: what they mean to do next is for them to answer."""
        return np.inf if self.alone else self._least(self._posed(root, upper), root, time, others_at=-np.inf)

    def clearance_from(self, moving: Moving, root: Floats, upper: Floats, time: float) -> float:
        """The same from some moving obstacles alone."""
        segments = self._posed(root, upper)
        return Obstacles(moving=moving).clearance(segments, self._radii, root[:2], time)

    def leaves_alone(self, thing: Moving, body: tuple[Floats, Floats], span: tuple[float, float], way: float) -> bool:
        """Whether a thing that moves `way` metres in a span of time keeps its margin from a body: root and upper body.

        Who has less than the margin already may not come nearer. All in between is free too: gaps change by no more
        than the way.
        """
        before, after = (self.clearance_from(thing, *body, time) for time in span)
        return after >= min(before, THING_MARGIN) and before + after > way

    def free_between(self, frames: Frames, clearances: tuple[float, float]) -> bool:
        """Whether all that a screen shows between two frames is proven free, by `halving`: straight interpolants.

        Where others move as they mean to, until the second frame. `clearances` are those of the frames.
        """
        way, first, last = self._levers.travel(frames.roots, frames.uppers), *frames.times
        ways, gaps = [way], np.array([[clearances[0]], [clearances[1]]], np.float32)
        if self._accompanied:
            ways += [way + around.moving.fastest * (last - first) for around in self._around]
            ways += [way + other.travel(first, last) for other in self.others]
            gaps = self._gaps(frames, _BOTH)
        proof = begun(gaps, np.array([ways]), 1, 0.0, _HALVINGS)
        parts, shares = np.empty(_LOOKS, np.int64), np.empty(_LOOKS)
        while (count := due(proof, parts, shares)) > 0:
            settle(proof, self._gaps(frames, shares[:count]), count)
        return bool(proof.least.min() >= 0.0)

    @property
    def _accompanied(self) -> bool:
        """Whether there is anything that can move."""
        return bool(self.others or self._around)

    @property
    def _around(self) -> list[Obstacles]:
        """The obstacles that can move: the scene's own, and what is loose."""
        return [each for each in (self._moving, self._loose) if len(each)]

    def _gaps(self, frames: Frames, shares: Floats) -> Floats32:
        """The clearances at shares (N,) of the time between two frames: from what stands (N, 1).

        Where anything can move, from that too, from what is loose, and from each of the others: a column for each.
        """
        (first, last), (begin, end), origin = frames.roots, frames.uppers, frames.roots[0][:2]
        root, upper = first + shares[:, None] * (last - first), begin + shares[:, None] * (end - begin)
        segments = self._capsules(np.hstack([root[:, :3], upper]), self._near(root, first))
        gaps = []
        for i, time in enumerate((frames.times[0] + shares * (frames.times[1] - frames.times[0])).tolist()):
            axes = np.ascontiguousarray(segments[:, :, i : i + 1])
            row = [self._standing.clearance(axes, self._radii, origin, time)]
            if self._accompanied:
                row += [around.clearance(axes, self._radii, origin, time) for around in self._around]
            gaps.append(row + [other.clearance(axes, self._radii, origin, time) for other in self.others])
        return np.array(gaps, np.float32)

    def _posed(self, root: Floats, upper: Floats) -> Floats32:
        """The capsules' axes (C, 6, 1) as seen from the root."""
        stood = self.standing(root)
        return self._capsules(configuration(root, upper)[None], self._near(stood, stood)[None])

    def standing(self, root: Floats) -> Floats:
        """A root state (ROOT_STATE,) with what the feet stand on."""
        stood: Floats = self._footing.stood(root[None])[0][0]
        return stood

    def _capsules(self, postures: Floats, roots: Floats) -> Floats32:
        """The capsules' axes (C, 6, N), those of the feet as high as they are held against what they stand on."""
        segments = posture_capsules(self.model, postures, roots)
        return self._footing.lifted(segments, self.model.body, roots, postures[:, LOWERING])

    def _least(
        self,
        segments: Floats32,
        origin: Floats,
        time: float,
        others_at: float | None = None,
        radii: Floats32 | None = None,
    ) -> float:
        """The least clearance of one posture (C, 6, 1) as seen from `origin`, at a time; `radii` (C,) of some."""
        axes, when = np.ascontiguousarray(segments), time if others_at is None else others_at
        sizes = self._radii if radii is None else radii
        found = self._obstacles.clearance(axes, sizes, origin[:2], time)
        if len(self._loose):
            found = min(found, self._loose.clearance(axes, sizes, origin[:2], time))
        return min([found, *(other.clearance(axes, sizes, origin, when) for other in self.others)])

    def _near(self, roots: Floats, origin: Floats) -> Floats:
        near = roots.copy()
        near[..., :2] -= origin[:2]
        return near
