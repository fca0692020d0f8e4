"""What is shown: one pose after the other, each proven free on the way from the last; where none is, that is held."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.footholds import UNKNOWN
from elbowroom.body.root import RootState
from elbowroom.control.feet.feet import Around, FeetMoment
from elbowroom.control.key_frame_queue import Playback
from elbowroom.control.plans.canned import standing_posture
from elbowroom.control.plans.planning_scene import PlanningScene
from elbowroom.control.shown.body_check import Frames
from elbowroom.control.shown.ducking import ducked
from elbowroom.control.shown.holding import Holding
from elbowroom.control.shown.retracing import Past, Retracing
from elbowroom.planning.stillness import UNMOVED, is_still

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

_SETTLING = (1.0, 0.2, 0.04)  # of a turn, by which legs come to a stand; less where that is not proven free
_TO_BEGIN = 0.002  # metres that a plan needs about the pose in which it begins: of what it has it may lose the half
_BREATHES = 1 / 31  # seconds: who rests need not move in every frame
_AGAIN = 0.1  # seconds: where legs have come no nearer to a stand it is not tried again sooner


class Showing:
    """The pose that one avatar shows, and how it goes on."""

    def __init__(self, around: PlanningScene, root: Floats, *, assist: bool) -> None:
        """Stand in a root state (ROOT_STATE,); its `clearance` tells whether that touches.

        Without `assist` poses are shown as they were planned, touching what they touch.
        """
        self.assist = assist
        self.holding, self._retracing = Holding(), Retracing()
        self._around, self._now = around, 0.0
        upper, stood = standing_posture(root), around.check.standing(root)
        standing = Playback(around.feet.standing(root), upper, np.zeros_like(upper))
        self._pose = self._before = self._free = standing
        self._meant = upper  # what was planned for the upper body that is shown
        self._clearance, self._posed_at = around.check.clearance(stood, upper, 0.0), 0.0
        self._again = 0.0  # seconds: when it is tried again how the legs of who is held come to a stand

    @property
    def pose(self) -> Playback:
        """What is shown: its root state is followed by feet and carriage."""
        return self._pose

    @property
    def clearance(self) -> float:
        """Metres about what is shown, negative where it touches."""
        return self._clearance

    @property
    def goes_back(self) -> bool:
        """Whether the avatar is to go back the way it came: its legs come to no stand where it is."""
        return self.assist and self._retracing.goes_back

    def go_among(self, around: PlanningScene) -> None:
        """Something else stands about it from now on."""
        self._around = around
        self._retracing.forget()

    def leave_touch(self) -> bool:
        """Show the last pose that was free, if what is shown touches; whether that was so."""
        if self._clearance >= 0.0:
            return False
        self._show(self._free, self._clearance_of(self._free.root, self._free.upper))
        return True

    def play(self, planned: Playback, ahead: Floats, now: float, dt: float) -> bool:
        """Show a planned pose as feet, hips and stance allow, if that is free; whether it is.

        It is `now` seconds, `dt` after the last time. `ahead` (m, 8) is what the root is to come to, seconds from now.
        """
        self._now = now
        played = self.holding.over(planned, dt)
        for posed, stance in self._around.feet.under(self._moment(dt, ahead), played):
            clearance = self._clearance_of(posed.root, posed.upper)
            if not self.assist or self._is_free(posed, clearance):
                self.holding.end(stance)
                self._show(posed, clearance)
                self._meant = planned.upper
                return True
        return False

    def hold(self, now: float, dt: float) -> None:
        """Stay in the last good pose; the legs come to a stand where they can, or else go back the way they came.

        Who stands already rests.
        """
        self._now = now
        self.holding.active = True
        if self.goes_back:
            self._go_back(dt)
        elif self._has_settled:
            self.rest(now, dt)
        else:
            self._settle(dt)

    @property
    def _has_settled(self) -> bool:
        """Whether the legs of who is held have come to a stand, arms stay, and nothing moves: then he rests.

        Who has just begun to stand there has yet to look whether his arms make way for the legs.
        """
        before, shown = self._before, self._pose
        if not self.assist or self._around.check.restless or before is shown or shown.upper is not before.upper:
            return False
        stands = is_still(shown.root[3:6]) and is_still(shown.upper_velocity)
        return stands and self._around.feet.are_still(before.root, shown.root)

    def _go_back(self, dt: float) -> None:
        """Show what was shown before, when it is time for that, if it is still free."""
        before = self._retracing.before(dt)
        if before is None:
            self._posed_at = self._now
            return
        arrival = self._retracing.arrival(self._pose, dt)
        if arrival is not None and self._goes_straight(arrival.pose):
            before = self._retracing.go_straight(self._pose, arrival, dt)
        elif not before.joined:
            self._retracing.forget()
            return
        posed = before.pose
        clearance = self._clearance_of(posed.root, posed.upper)
        if self._around.check.accompanied and not self._touches_nothing(clearance, self._frames_to(posed)):
            self._retracing.give_up()
            return
        self._retracing.went()
        self._show(posed, clearance, back=True)

    def _goes_straight(self, to: Playback) -> bool:
        """Whether what stands leaves the straight way from what is shown to another pose on the spot free."""
        shown = self._pose
        return self._around.check.free_between(
            Frames((shown.root, to.root), (shown.upper, to.upper), (self._now, self._now))
        )

    def _settle(self, dt: float) -> None:
        """Stay, as the legs come to a stand where they can, and leave the room that a motion needs to begin.

        Where they cannot that is not tried again in each frame, but for who touches what has come upon him.
        """
        restless = self._around.check.restless
        least = 0.0 if restless else min(self._clearance, _TO_BEGIN)
        waits = self._now < self._again and self._clearance >= 0.0
        for still in () if waits else self._settling(dt):
            clearance = self._clearance_of(still.root, still.upper)
            if not self.assist or (clearance >= least and self._is_free(still, clearance)):
                break
        else:
            self._again = self._again if waits else self._now + _AGAIN
            still = self._pose._replace(upper_velocity=np.zeros_like(self._pose.upper))
            clearance = self._clearance_of(still.root, still.upper) if restless else self._clearance
        self._show(still, clearance)

    def wait(self, dt: float, *, on_the_way: bool) -> None:
        """There is no way on from where it stands, and the user pushes, or it is `on_the_way` to a place."""
        self._retracing.wait(self._pose, dt, on_the_way=on_the_way)

    def rest(self, now: float, dt: float) -> None:
        """Who rests lives on where that touches nothing: breathes, and shifts its weight."""
        self._now, since = now, now - self._posed_at
        if not self.assist or dt <= 0.0 or since < _BREATHES:
            return
        posed = self._around.feet.resting(self._moment(since))
        if posed is self._pose:
            return
        clearance = self._clearance_of(posed.root, posed.upper)
        if self._is_free(posed, clearance):
            self._show(posed, clearance)

    def follow(self, shown: Playback, planned: Playback, dt: float, ahead: Floats) -> Playback:
        """How a pose will be shown `dt` seconds after what is `shown` then, if that is free."""
        return self._around.feet.next(self._moment(dt, ahead)._replace(shown=shown, meant=shown.upper), planned)

    def changes_nothing(self, states: Floats, uppers: Floats) -> bool:
        """Whether a motion (n, ROOT_STATE), (n, LOCAL) stands as what is shown does, in the same pose."""
        shown = self._pose
        if not self._around.feet.are_still(self._before.root, shown.root):
            return False
        if not all(map(is_still, (states[:, 3:6], shown.root[3:6], self.holding.stance, shown.upper_velocity))):
            return False
        return bool(np.abs(uppers - shown.upper).max() < UNMOVED)

    def _settling(self, dt: float) -> Iterator[Playback]:
        """How the pose that is shown can be held, with what it stands on: best first; at last lower, to be able to."""
        feet, moment, shown = self._around.feet, self._moment(dt), self._pose
        parts = [part * dt for part in (_SETTLING if self.assist else _SETTLING[:1])]
        ended = is_still(shown.root[3:6])
        for part in parts[:1] if ended else parts:
            yield from feet.settling(moment, self.holding.settle(shown, part))
        root = RootState.of(shown.root)._replace(forward=0.0, lateral=0.0, turn=0.0).as_array()
        stood = self._around.check.standing(root)
        for part in parts:
            lower = ducked(self.holding.settle(shown, part), stood, part, self._clearance_of)
            if lower is not None:
                yield from feet.settling(moment, lower)

    def _moment(self, dt: float, ahead: Floats = UNKNOWN) -> FeetMoment:
        """What feet go by; without assistance nothing is looked at, and hips are as planned."""
        check = self._around.check
        return FeetMoment(
            self._pose, self._meant, dt, ahead, self._room(), self._look, check.room_along, check.room_above
        )

    def _room(self) -> float:
        """Metres about the body as it is shown; where ground is not plain, about what the shins carry."""
        check = self._around.check
        if not self.assist:
            return -1.0
        if check.footing.plain:
            return max(self._clearance, 0.0)
        return max(check.room_of_trunk(self._pose.root, self._pose.upper, self._now), 0.0)

    def _look(self, root: Floats, upper: Floats, axes: Floats32 | None = None) -> Around:
        """What stands and moves about a body."""
        check = self._around.check
        return Around(check.room_of_legs(root, upper, self._now, axes), not check.accompanied)

    def _clearance_of(self, root: Floats, upper: Floats) -> float:
        """Of a pose, now."""
        return self._around.check.shown_clearance(root, upper, self._now)

    def _is_free(self, posed: Playback, clearance: float) -> bool:
        """Whether the pose can be shown: neither it nor the way to it touches anything, or is in itself."""
        frames = self._frames_to(posed)
        return self._touches_nothing(clearance, frames) and self._keeps_out_of_itself(frames)

    def _touches_nothing(self, clearance: float, frames: Frames) -> bool:
        """Whether a pose touches nothing that stands or moves about it, nor the way to it from what is shown."""
        check = self._around.check
        if check.restless and self._clearance < 0.0 and clearance >= self._clearance:
            return True  # away from what has come upon it
        return clearance >= 0.0 and check.leaves_room(frames) and check.free_between(frames)

    def _keeps_out_of_itself(self, frames: Frames) -> bool:
        """Whether no part of the body comes deeper into another than it may, from the pose that is shown on.

        Of planners that see to that.
        """
        own_body = self._around.own_body
        return own_body is None or own_body.free_between(self._around.check.between(frames))

    def _frames_to(self, posed: Playback) -> Frames:
        """What is shown, and the pose that comes next."""
        shown = self._pose
        return Frames((shown.root, posed.root), (shown.upper, posed.upper), (self._posed_at, self._now))

    def _show(self, pose: Playback, clearance: float, *, back: bool = False) -> None:
        if clearance < 0.0 or self._clearance < 0.0 or not self.assist:
            self._retracing.forget()
        elif not back:
            self._retracing.show(Past(self._pose, self._now - self._posed_at), pose)
        if pose.root is not self._pose.root:
            self._again = self._now
        self._before = self._pose
        self._pose, self._clearance, self._posed_at = pose, clearance, self._now
        self._meant = pose.upper
        if clearance >= 0.0:
            self._free = pose
