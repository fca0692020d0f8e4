"""The avatar's feet and hips under what is played.

Feet step as the root goes, and wait or glide where no step can be shown. Hips, chest and head live (`body/living.py`)
as far as there is room, and are where they were planned where there is none.
"""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOWERING, DofGroup, columns_of
from elbowroom.body.footholds import UNKNOWN, beside, gliding, onward, settled, standing
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.kinematics import body_model, lower_body
from elbowroom.body.living import lively, living
from elbowroom.body.root import CARRIAGE, ROOT_STATE, WITH_FEET
from elbowroom.clips.motion_set import MotionSet
from elbowroom.control.arms_beside_legs import ArmsBesideLegs
from elbowroom.control.key_frame_queue import Playback
from elbowroom.planning.shared import Shared

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]


class Around(NamedTuple):
    """What is about a body."""

    room: float  # metres from the legs to the nearest obstacle
    axes: Floats32  # (C, 6, 1) of its capsules


class Ahead(NamedTuple):
    """What is known of what comes."""

    roots: Floats  # (m, 8) seconds from now and root states that the root is to come to
    room: float  # metres about the whole body as it is shown


Look = Callable[[Floats, Floats], Around]  # for a root with feet and an upper body

_ROOM = 0.10  # metres about the legs in which feet step as they like
_STRAIN = 0.3  # half leg lengths that hips come down, beyond the stride, to a foot that waits
_TWIST, _HEAD_TURN = (columns_of(group).start + 1 for group in (DofGroup.WAIST, DofGroup.HEAD))
_NOT_AT_ALL = -1.0  # metres of room in which hips are where they were planned at once

_ARMS: Shared[ArmsBesideLegs] = Shared()


class Stepping:
    """How one avatar stands and steps; frozen, the state of its feet is in the root states that are shown."""

    def __init__(self, humanoid: Humanoid, motions: MotionSet) -> None:
        """`motions` are those that it walks with."""
        model = body_model(humanoid)
        self._gait = model.gait
        self._arms = _ARMS.get((humanoid, motions), lambda: ArmsBesideLegs(model, motions))

    def standing(self, root: Floats) -> Floats:
        """A root state (7,) with feet beside each other, carried as planned, (SHOWN,)."""
        return np.concatenate([beside(self._gait, root), np.zeros(CARRIAGE)])

    def rests(self, root: Floats) -> bool:
        """Whether the feet of a root state (SHOWN,) make no step while the root rests."""
        return settled(self._gait, root)

    def stay(self, before: Floats, root: Floats) -> bool:
        """Whether both feet stand, and are where they were: no step can be shown, or none is needed."""
        same = np.array_equal(before[ROOT_STATE:WITH_FEET], root[ROOT_STATE:WITH_FEET])
        return bool(standing(root).all() and same)

    def breathing(self, shown: Playback, dt: float, room: float) -> Playback:
        """What is shown, `dt` seconds later, of who rests with `room` metres about the body."""
        return self._alive(shown.root[:WITH_FEET], shown, shown, dt, Ahead(UNKNOWN, room))

    def settling(self, shown: Playback, posed: Playback, dt: float, room: float, look: Look) -> list[Playback]:
        """A pose that is held, on the feet that follow on what is shown within `dt` seconds: best first.

        Arms make way for legs that come to a stand; if that touches they stay.
        """
        steps, glides = (follow(self._gait, shown.root, posed.root, dt) for follow in (onward, gliding))
        roots = [steps, glides] if look(steps, posed.upper).room >= _ROOM else [glides, steps]
        made = [self._alive(root, posed, shown, dt, Ahead(UNKNOWN, room)) for root in roots]
        if any(lively(pose.root) for pose in made):
            made += [self._alive(root, posed, shown, dt, Ahead(UNKNOWN, _NOT_AT_ALL)) for root in roots]
        return [pose._replace(upper=self._arms.apart(pose.root, pose.upper)) for pose in made] + made

    def next(self, shown: Playback, posed: Playback, dt: float, ahead: Ahead, look: Look) -> Playback:
        """How a pose is shown `dt` seconds after what is `shown`, if that is free: see `under`."""
        after = self._alive(onward(self._gait, shown.root, posed.root, dt, ahead.roots), posed, shown, dt, ahead)
        around = look(after.root, posed.upper)
        if around.room < _ROOM:
            after = self._glides(shown, posed, dt, ahead)
            around = look(after.root, posed.upper)
        return after._replace(upper=self._arms.apart(after.root, posed.upper, around.axes))

    def under(
        self, played: list[tuple[Playback, Floats]], shown: Playback, ahead: Ahead, dt: float, look: Look
    ) -> Iterator[tuple[Playback, Floats]]:
        """Poses that could be shown after `dt` seconds, each with its stance, on feet that follow on what is `shown`.

        Where legs have room feet step to where the root is to come, else they glide to where they were planned, and
        arms make way for the legs. If that touches, hips are as planned; then feet glide and arms go as planned; or
        feet step, or wait.
        """
        still = ahead._replace(room=_NOT_AT_ALL)
        for posed, stance in played:
            alive = self.next(shown, posed, dt, ahead, look)
            yield alive, stance
            if lively(shown.root) or lively(alive.root):
                yield self.next(shown, posed, dt, still, look), stance
        for posed, stance in played:
            yield self._glides(shown, posed, dt, still), stance
        for posed, stance in played:
            root = onward(self._gait, shown.root, posed.root, dt, ahead.roots)
            yield self._alive(root, posed, shown, dt, still), stance
        for posed, stance in played:
            root = onward(self._gait, shown.root, posed.root, 0.0)
            if not self._is_strained(root, posed.upper):
                yield self._alive(root, posed, shown, dt, still), stance

    def _glides(self, shown: Playback, posed: Playback, dt: float, ahead: Ahead) -> Playback:
        return self._alive(gliding(self._gait, shown.root, posed.root, dt), posed, shown, dt, ahead)

    def _alive(self, root: Floats, posed: Playback, shown: Playback, dt: float, ahead: Ahead) -> Playback:
        """A pose on a root with feet (WITH_FEET,), with hips, chest and head that live."""
        faces = float(posed.upper[_TWIST] + posed.upper[_HEAD_TURN])
        return posed._replace(root=living(self._gait, shown.root, root, dt, ahead.room, ahead.roots, faces))

    def _is_strained(self, root: Floats, upper: Floats) -> bool:
        """Whether a foot that has waited lies so far behind that the hips would come far down to it."""
        lowering, state = upper[LOWERING - DofGroup.ROOT.size :][:1].copy(), root[None, :ROOT_STATE].copy()
        sinks = [lower_body(self._gait, rows, lowering)[1][0, 0] for rows in (root[None], state)]
        return bool(sinks[0] - sinks[1] > _STRAIN * self._gait.half_leg)
