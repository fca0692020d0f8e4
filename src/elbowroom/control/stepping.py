"""The avatar's feet under what is played: they step as the root goes, and wait or glide where no step can be shown."""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOWERING, DofGroup
from elbowroom.body.footholds import beside, gliding, onward, settled, standing
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.kinematics import body_model, lower_body
from elbowroom.body.root import ROOT_STATE
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


Look = Callable[[Floats, Floats], Around]  # for a root with feet and an upper body

_ROOM = 0.10  # metres about the legs in which feet step as they like
_STRAIN = 0.3  # half leg lengths that hips come down, beyond the stride, to a foot that waits

_ARMS: Shared[ArmsBesideLegs] = Shared()


class Stepping:
    """How one avatar stands and steps; frozen, the state of its feet is in the root states that are shown."""

    def __init__(self, humanoid: Humanoid, motions: MotionSet) -> None:
        """`motions` are those that it walks with."""
        model = body_model(humanoid)
        self._gait = model.gait
        self._arms = _ARMS.get((humanoid, motions), lambda: ArmsBesideLegs(model, motions))

    def standing(self, root: Floats) -> Floats:
        """A root state (7,) with feet beside each other, (WITH_FEET,)."""
        return beside(self._gait, root)

    def rests(self, root: Floats) -> bool:
        """Whether the feet of a root state (WITH_FEET,) make no step while the root rests."""
        return settled(self._gait, root)

    def stay(self, before: Floats, root: Floats) -> bool:
        """Whether both feet stand, and are where they were: no step can be shown, or none is needed."""
        return bool(standing(root).all() and np.array_equal(before[ROOT_STATE:], root[ROOT_STATE:]))

    def settling(self, shown: Playback, posed: Playback, dt: float, look: Look) -> list[Playback]:
        """A pose that is held, on the feet that follow on what is shown within `dt` seconds: best first."""
        steps, glides = (follow(self._gait, shown.root, posed.root, dt) for follow in (onward, gliding))
        roots = [steps, glides] if look(steps, posed.upper).room >= _ROOM else [glides, steps]
        return [posed._replace(root=root) for root in roots]

    def next(self, shown: Playback, posed: Playback, dt: float, ahead: Floats, look: Look) -> Playback:
        """How a pose is shown `dt` seconds after what is `shown`, if that is free: see `under`."""
        root = onward(self._gait, shown.root, posed.root, dt, ahead)
        around = look(root, posed.upper)
        if around.room < _ROOM:
            root = gliding(self._gait, shown.root, posed.root, dt)
            around = look(root, posed.upper)
        return posed._replace(root=root, upper=self._arms.apart(root, posed.upper, around.axes))

    def under(
        self, played: list[tuple[Playback, Floats]], shown: Playback, ahead: Floats, dt: float, look: Look
    ) -> Iterator[tuple[Playback, Floats]]:
        """Poses that could be shown after `dt` seconds, each with its stance, on feet that follow on what is `shown`.

        Where legs have room feet step to where the root is to come, `ahead` (m, 8), else they glide to where they were
        planned, and arms make way for the legs. If that touches, feet glide and arms go as planned; or feet step, or
        wait.
        """
        for posed, stance in played:
            yield self.next(shown, posed, dt, ahead, look), stance
        for posed, stance in played:
            yield posed._replace(root=gliding(self._gait, shown.root, posed.root, dt)), stance
        for posed, stance in played:
            yield posed._replace(root=onward(self._gait, shown.root, posed.root, dt, ahead)), stance
        for posed, stance in played:
            root = onward(self._gait, shown.root, posed.root, 0.0)
            if not self._is_strained(root, posed.upper):
                yield posed._replace(root=root), stance

    def _is_strained(self, root: Floats, upper: Floats) -> bool:
        """Whether a foot that has waited lies so far behind that the hips would come far down to it."""
        lowering, state = upper[LOWERING - DofGroup.ROOT.size :][:1].copy(), root[None, :ROOT_STATE].copy()
        sinks = [lower_body(self._gait, rows, lowering)[1][0, 0] for rows in (root[None], state)]
        return bool(sinks[0] - sinks[1] > _STRAIN * self._gait.half_leg)
