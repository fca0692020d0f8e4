"""The last word before a pose is shown: how far the whole body is from every obstacle, and from every other avatar."""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DOF, LOCAL, LOWERING, DofGroup
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.between_frames import FramePair, frame_pair
from elbowroom.body.pose.kinematics import body_model
from elbowroom.body.pose.whole_body import posed_joints
from elbowroom.control.feet.above_soles import AboveSoles
from elbowroom.control.others.neighbour import Neighbour
from elbowroom.control.others.room_left import in_world, leaves_room
from elbowroom.control.shown.standing_about import (
    HALVINGS,
    gaps_about,
    held_between,
    held_capsules,
    proven_between,
    room_along,
    ways_between,
)
from elbowroom.planning.halving import begun, due, settle
from elbowroom.planning.model.footing import Footing
from elbowroom.planning.stillness import STILL
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.tracks.moving import Moving
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Indices = NDArray[np.int64]

_LOOKS = 8  # at once
THING_MARGIN = 0.03  # metres that stay between the body that is shown and what is pushed towards it
_REMEMBERED = 4  # poses
_LOWERING = LOWERING - DofGroup.ROOT.size  # its place in an upper body


def configuration(root: Floats, upper: Floats) -> Floats:
    """The configuration `q` (DOF,) of a root state (7,) and an upper body (LOCAL,)."""
    return np.concatenate([root[: DOF - LOCAL], upper])


class Frames(NamedTuple):
    """Two frames that are shown one after the other."""

    roots: tuple[Floats, Floats]  # (SHOWN,)
    uppers: tuple[Floats, Floats]  # (LOCAL,)
    times: tuple[float, float]  # seconds


class _Pose(NamedTuple):
    """A pose that was asked about, and where it puts the body."""

    root: Floats  # (ROOT_STATE,), (WITH_FEET,) or (SHOWN,)
    upper: Floats  # (LOCAL,)
    joints: tuple[Floats, Floats]  # rotations (J, 4) and place of the hips (3,), see `posed_joints`
    axes: Floats32  # (C, 6, 1) the capsules' axes as seen from the root's place
    floors: Floats  # (2,) heights that the soles keep above, see `AboveSoles.floors`
    gaps: Floats32  # (C,) how far each capsule is from what stands; of the nearest that, of others at least so much
    rooms: list[float]  # the same numbers


class BodyCheck:
    """Clearance of a humanoid's whole collision body in a scene, at a time; what moves stands where it is then.

    The same pose is asked about several times in a frame and in the next: the last few are remembered, and known by
    their arrays, which nobody may change. Playback and planning may ask at once, each in its thread.
    """

    def __init__(self, humanoid: Humanoid, scene: Scene) -> None:
        self.model = body_model(humanoid)  # its joints and capsules, as kernels take them
        self._radii = humanoid.capsules.radii.astype(np.float32)
        self.soles = AboveSoles(self.model, scene.ground)  # how it stands on the ground here
        moving = scene.obstacles.moving
        self._standing = replace(scene.obstacles, moving=Moving()) if len(moving) else scene.obstacles
        self._moving, self._loose = Obstacles(moving=moving), Obstacles()
        self._around = self._that_can_move()
        self._empty = not len(scene.obstacles)
        self._nowhere = np.full(len(self._radii), np.inf, np.float32)  # the gaps where nothing stands
        self._legs: list[int] = self.model.roots.indices.tolist()  # the numbers of their capsules
        self._above = [number for number in range(len(self._radii)) if number not in self._legs]
        self._poses: tuple[_Pose, ...] = ()  # latest first
        self._between: tuple[Frames, FramePair] | None = None  # the frames that were asked about last
        self.others: Sequence[Neighbour] = ()  # other avatars, as they say that they will move
        self.told: Neighbour | None = None  # what they know of this one

    @property
    def footing(self) -> Footing:
        """How feet stand on the ground here."""
        return self.soles.footing

    @property
    def alone(self) -> bool:
        """Whether there is nothing and nobody else: then no pose has to be looked at."""
        return self._empty and not self.accompanied

    @property
    def loose(self) -> Moving:
        """What was taken in hand, as it moves from the frame that is shown to the next."""
        return self._loose.moving

    @loose.setter
    def loose(self, things: Moving) -> None:
        self._loose = Obstacles(moving=things)
        self._around = self._that_can_move()

    @property
    def restless(self) -> bool:
        """Whether anything moves that is not the avatar's own."""
        return bool(len(self._moving) or self.others) or self.loose.fastest > STILL

    def clearance(self, root: Floats, upper: Floats, time: float) -> float:
        """Metres from the nearest obstacle, negative where the body touches, for root (7,) and upper body (LOCAL,).

        The root may be followed by feet and carriage, here and below, and tells what feet stand on (`standing`). That
        is left out as `above_soles.py` tells.

        The avatar is put at the origin and the obstacles move instead, so that single precision holds anywhere.
        """
        return np.inf if self.alone else self._least(self._pose(root, upper), time, time)

    def body(self, root: Floats, upper: Floats) -> Floats:
        """The ends of the capsules as seen from the root's place, and their radii, (C, 7) metres."""
        return np.column_stack([self.axes(root, upper)[:, :, 0], self._radii]).astype(np.float64)

    def axes(self, root: Floats, upper: Floats) -> Floats32:
        """The capsules' axes (C, 6, 1) as seen from the root's place."""
        return self._pose(root, upper).axes

    def room_of_legs(self, root: Floats, upper: Floats, time: float, axes: Floats32 | None = None) -> float:
        """Metres from the legs to the nearest obstacle, as `shown_clearance` of the whole body.

        `axes` are those of the pose, where they are known; they are remembered where nothing stands too.
        """
        return self._least(self._pose(root, upper, axes), time, -np.inf, self._legs)

    def room_along(self, roots: Floats, upper: Floats, farthest: float) -> float:
        """Metres from the legs to what stands about feet, the least of root states (N, WITH_FEET); `farthest` at most.

        Feet are held some millimetres higher, where ground is not plain: so what they stand on counts as no nearer.
        """
        if self._empty:
            return farthest
        lowering, standing = float(upper[_LOWERING]), self._standing.about_bodies
        return room_along(self.soles.legs, standing, roots, lowering, farthest)

    def room_above(self, root: Floats, upper: Floats) -> float:
        """Metres from all that is carried by pelvis and legs to what stands."""
        return np.inf if self._empty else _least(self._pose(root, upper).rooms, self._above)

    def room_of_trunk(self, root: Floats, upper: Floats, time: float) -> float:
        """The same of all that is carried by the shins: what feet stand on, and go over, is no nearer for them."""
        return np.inf if self.alone else self._least(self._pose(root, upper), time, -np.inf, self.soles.carried)

    def shown_clearance(self, root: Floats, upper: Floats, time: float) -> float:
        """The same while others still are as they were shown last: what they mean to do next is for them to answer."""
        return np.inf if self.alone else self._least(self._pose(root, upper), time, -np.inf)

    def clearance_from(self, moving: Moving, root: Floats, upper: Floats, time: float) -> float:
        """The same from some moving obstacles alone."""
        return Obstacles(moving=moving).clearance(self.axes(root, upper), self._radii, root[:2], time)

    def leaves_alone(self, thing: Moving, body: tuple[Floats, Floats], span: tuple[float, float], way: float) -> bool:
        """Whether a thing that moves `way` metres in a span of time keeps its margin from a body: root and upper body.

        Who has less than the margin already may not come nearer. All in between is free too: gaps change by no more
        than the way.
        """
        before, after = (self.clearance_from(thing, *body, time) for time in span)
        return after >= min(before, THING_MARGIN) and before + after > way

    def free_between(self, frames: Frames) -> bool:
        """Whether all that a screen shows between two frames is proven free, by `halving`.

        Each capsule by itself of what stands, the whole body of what moves. Where others move as they mean to, until
        the second frame.
        """
        if self.alone:
            return True
        before, after = self._ends(frames)
        floors, gaps = np.minimum(before.floors, after.floors), (before.gaps, after.gaps)
        if self.soles.change(before.floors, after.floors):
            gaps = self._gaps(before.axes, before.root, floors), self._gaps(after.axes, after.root, floors)
        axes, standing, shown = (before.axes, after.axes), self._standing.about_bodies, self.between(frames)
        if not proven_between(self.soles.body, standing, shown, frames.uppers, axes, gaps, floors):
            return False
        return not self.accompanied or self._free_of_movers(frames, (before, after))

    def between(self, frames: Frames) -> FramePair:
        """What a screen shows between two frames, for kernels; remembered of those that were asked about last."""
        known = self._between
        if known is None or known[0] is not frames:
            first, second = self._ends(frames)
            self._between = known = frames, frame_pair(frames.roots, first.joints, second.joints)
        return known[1]

    def _ends(self, frames: Frames) -> tuple[_Pose, _Pose]:
        (first, last), (begin, end), _ = frames
        return self._pose(first, begin), self._pose(last, end)

    def leaves_room(self, frames: Frames) -> bool:
        """Whether the second frame leaves others the room that they count on; see `others/room_left.py`."""
        if self.told is None or not self.others:
            return True
        was, shown = (in_world(end.axes, end.root) for end in self._ends(frames))
        return all(leaves_room(self.told, other, was, shown, frames.times[1]) for other in self.others)

    def _free_of_movers(self, frames: Frames, ends: tuple[_Pose, _Pose]) -> bool:
        """Whether the whole body is proven free of all that can move between two frames."""
        first, last = frames.times
        moved = [around.moving.fastest * (last - first) for around in self._around]
        moved += [other.travel(first, last) for other in self.others]
        before, after = ends
        own = ways_between(self.soles.body, self.between(frames), frames.uppers, (before.axes, after.axes))
        ways = float(own.max()) + np.array([moved])
        gaps = [self._from_movers(end.axes, end.root, time) for end, time in zip(ends, frames.times, strict=True)]
        proof = begun(np.array(gaps, np.float32), ways, 1, 0.0, HALVINGS)
        parts, shares = np.empty(_LOOKS, np.int64), np.empty(_LOOKS)
        while (count := due(proof, parts, shares)) > 0:
            settle(proof, self._from_movers_at(frames, shares[:count]), count)
        return bool(proof.least.min() >= 0.0)

    @property
    def accompanied(self) -> bool:
        """Whether there is anything that can move."""
        return bool(self.others or self._around)

    def _that_can_move(self) -> list[Obstacles]:
        """The obstacles that can move: the scene's own, and what is loose."""
        return [each for each in (self._moving, self._loose) if len(each)]

    def _from_movers_at(self, frames: Frames, shares: Floats) -> Floats32:
        """The clearances (k, M) from all that can move at shares (k,) of the time between two frames."""
        before, after = frames.times
        axes, root = held_between(self.soles.body, self.between(frames), frames.uppers, shares), frames.roots[0]
        times = before + shares * (after - before)
        found = [self._from_movers(axes[:, :, [n]], root, time) for n, time in enumerate(times.tolist())]
        return np.array(found, np.float32)

    def _from_movers(self, axes: Floats32, root: Floats, time: float) -> list[float]:
        """The clearances of the axes (C, 6, 1) about a root's place from all that can move, and from each other."""
        moving = [around.clearance(axes, self._radii, root[:2], time) for around in self._around]
        return moving + [other.clearance(axes, self._radii, root, time) for other in self.others]

    def _gaps(self, axes: Floats32, root: Floats, floors: Floats) -> Floats32:
        """How far each of the axes (C, 6, 1) about a root's place is from what stands, (C,)."""
        if self._empty:
            return self._nowhere
        (x, z), standing = root[:2].tolist(), self._standing.about_bodies
        return gaps_about(self._radii, self.soles.body.sides, standing, axes, x, z, floors, np.inf)

    def _pose(self, root: Floats, upper: Floats, axes: Floats32 | None = None) -> _Pose:
        """A pose, remembered; its `axes` may be known."""
        for pose in self._poses:
            if pose.root is root and pose.upper is upper:
                return pose
        own, here, above = self.soles.body, np.ascontiguousarray(root), np.ascontiguousarray(upper)
        joints = posed_joints(own.whole, configuration(here, above), here)
        if axes is None:
            axes = held_capsules(own, here, above, joints)
        floors = self.soles.floors(root)
        gaps = self._gaps(axes, root, floors)
        pose = _Pose(root, upper, joints, axes, floors, gaps, gaps.tolist())
        self._poses = (pose, *self._poses[: _REMEMBERED - 1])
        return pose

    def standing(self, root: Floats) -> Floats:
        """A root state (ROOT_STATE,) with what the feet stand on."""
        stood: Floats = root if self.soles.footing.plain else self.soles.footing.stood(root[None])[0][0]
        return stood

    def _least(self, pose: _Pose, time: float, others_at: float, parts: list[int] | None = None) -> float:
        """The least clearance of a pose, or of some `parts` of it; from others as they are at a time of theirs."""
        room = _least(pose.rooms, parts)
        if not self.accompanied:
            return room
        some = slice(None) if parts is None else parts
        axes, radii = np.ascontiguousarray(pose.axes[some]), self._radii[some]
        found = [around.clearance(axes, radii, pose.root[:2], time) for around in self._around]
        found += [other.clearance(axes, radii, pose.root, others_at) for other in self.others]
        return min(room, *found)


def _least(rooms: list[float], parts: list[int] | None) -> float:
    return min(rooms) if parts is None else min(map(rooms.__getitem__, parts))
