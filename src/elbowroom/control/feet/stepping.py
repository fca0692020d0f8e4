"""The avatar's feet and hips under what is played.

Feet step as the root goes, on the plane and on any other ground, and wait or glide where no step can be shown. Hips,
chest and head live (`body/gait/living.py`) as far as there is room, and are where they were planned where there is
none.
"""

from collections.abc import Callable, Iterator, Sequence
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOWERING, DofGroup, columns_of
from elbowroom.body.fitting.fit import FitSettings
from elbowroom.body.gait.foot_state import standing
from elbowroom.body.gait.footholds import UNKNOWN, beside, settled
from elbowroom.body.gait.gliding import gliding
from elbowroom.body.gait.landing_places import Stepper
from elbowroom.body.gait.living import body_of, living
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, lower_body
from elbowroom.body.root import CARRIAGE, RISES, ROOT_STATE, WITH_FEET
from elbowroom.clips.motion_set import MotionSet
from elbowroom.control.feet.above_soles import AboveSoles
from elbowroom.control.feet.arms_beside_legs import arms_beside_legs
from elbowroom.control.feet.feet import FeetMoment
from elbowroom.control.feet.feet_ahead import glides_ahead, steps_ahead
from elbowroom.control.feet.following import GLIDES, HOLDS, STEPS, Followed, Follower, Gaps, followed
from elbowroom.control.feet.posing import NOT_AT_ALL, Posing
from elbowroom.control.feet.raised import raised
from elbowroom.control.feet.trunk_over_legs import trunk_over_legs
from elbowroom.control.key_frame_queue import Playback

Floats = NDArray[np.float64]

_ROOM = 0.10  # metres about the legs in which feet step as they like
CLEAR = 0.004  # metres about the legs that have to stay, where there are less, as far ahead as is known
_NO_CLEARER = 0.0005  # metres: feet that stand do not glide to have so much more about legs
_FORESEEN = 0.75  # seconds that are looked ahead
_FOLDED = 0.02  # metres from trunk to thighs, beyond what they may come near: with more it is not looked ahead
_SAME = 1e-9  # metres and radians
_STRAIN = 0.3  # half leg lengths that hips come down, beyond the stride, to a foot that waits
_TWIST, _HEAD_TURN = (columns_of(group).start + 1 for group in (DofGroup.WAIST, DofGroup.HEAD))
_SKIN = FitSettings().tip_margin  # metres that skin of the upper body may be outside of its capsules
_FARTHER = 0.002  # metres that another way has to keep off more, to be taken for it
_LONG = 60.0  # seconds in which feet have glided wherever they were planned


class Stepping:
    """How one avatar stands and steps; frozen, the state of its feet is in the root states that are shown."""

    def __init__(self, humanoid: Humanoid, motions: MotionSet, soles: AboveSoles) -> None:
        """`motions` are those that it walks with, `soles` stand on the ground there."""
        model = body_model(humanoid)
        self._gait, self._own, self._footing = model.gait, motions.own_steps, soles.footing
        self._body = body_of(model.gait, motions.style.manner, motions.own_stride(model.gait))
        self._arms, self._trunk = arms_beside_legs(humanoid, motions), trunk_over_legs(humanoid, motions)
        feet = Stepper(model.gait.legs, model.gait.scale, self._own)
        pairs = self._arms.pairs.and_those(self._trunk.pairs)
        self._follower = Follower(soles.body, feet, self._body, pairs, soles.footing.underfoot)

    def standing(self, root: Floats) -> Floats:
        """A root state (ROOT_STATE,) with feet beside each other, carried as planned, (SHOWN,)."""
        return np.concatenate([beside(self._gait, self._stood(root)), np.zeros(CARRIAGE)])

    def are_still(self, before: Floats, shown: Floats) -> bool:
        """Whether feet that are shown (SHOWN,), after others, make no step while the root rests.

        They are where they were and stand, so that no step can be shown or none is needed; or none is left to make.
        """
        rises, moved = (
            np.abs(shown[part] - before[part]).max() for part in (slice(RISES, ROOT_STATE), slice(RISES, WITH_FEET))
        )
        settles = rises < _SAME and settled(self._gait, shown)
        return bool(standing(shown).all() and moved < _SAME) or bool(settles)

    def resting(self, moment: FeetMoment) -> Playback:
        """What who rests shows next: it breathes, and shifts its weight."""
        return self._alive(moment._replace(ahead=UNKNOWN), moment.shown.root[:WITH_FEET], moment.shown)

    def settling(self, moment: FeetMoment, held: Playback) -> Iterator[Playback]:
        """How a pose that is held could be shown next, as legs come to a stand: best first.

        Arms make way for legs that come to a stand; if that touches they stay, where no arm comes deeper into a leg.
        Each pose is made when it is asked for, and none twice.
        """
        alive = self._posing(moment._replace(ahead=UNKNOWN), held)
        steps = alive.made(STEPS)
        roomy = alive.moment.look(steps.root, held.upper, steps.axes).room >= _ROOM
        # Where ground is not plain that is what is about legs, the ground under them too.
        roomy = roomy or (not self._footing.plain and alive.room(steps.root[None, :WITH_FEET]) >= CLEAR)
        stays: list[Playback] = []
        for it, pose in self._all_ways(alive, (STEPS, GLIDES) if roomy else (GLIDES, STEPS)):
            made_way = pose.upper is not held.upper
            upper = pose.upper if made_way else self._arms.apart(pose.root, pose.upper, it.gaps(pose))
            if upper is not pose.upper:
                stays.append(pose)
            yield pose._replace(upper=upper)
        if stays:
            deepest = min(self._arms.room(*moment.shown[:2]), 0.0)
            yield from (pose for pose in stays if self._arms.room(pose.root, pose.upper) >= deepest)

    def next(self, moment: FeetMoment, posed: Playback) -> Playback:
        """How a pose is shown next, if that is free: see `under`."""
        return self._next(self._posing(moment, posed))

    def _next(self, it: Posing) -> Playback:
        moment, posed, after = it.moment, it.posed, it.made(STEPS)
        around = moment.look(after.root, posed.upper, after.axes)
        if around.room < _ROOM and not around.lasts:
            after = it.made(GLIDES)
        elif around.room < _ROOM:
            after = self._clearest(it, it.room)
        if after.trunk < _FOLDED and after is it.made(STEPS):
            after = self._clearest(it, lambda rows: self._trunk.room(rows, posed.upper))
        upper = self._arms.apart(after.root, posed.upper, after.gaps)
        if moment.shown.upper is not moment.meant:
            upper = self._arms.coming_back(upper, posed.upper, moment.shown.upper - moment.meant, moment.dt)
        return Playback(after.root, upper, posed.upper_velocity)

    def under(self, moment: FeetMoment, played: Sequence[tuple[Playback, Floats]]) -> Iterator[tuple[Playback, Floats]]:
        """Poses that could be shown next, each with its stance (3,), on feet that follow on what is shown.

        Where legs have room, and will have some, from the trunk too, feet step to where the root is to come, else they
        glide to where they were planned, and arms make way for the legs. If that touches, hips are as planned; then
        feet glide and arms go as planned; or feet step, or wait. Last come those with an arm too deep in a leg.
        """
        in_legs: list[tuple[Playback, Floats]] = []
        told: list[Playback] = []
        for way, stance, clear in self._ways_under(moment, played):
            if any(way.root is other.root and way.upper is other.upper for other in told):
                continue
            told.append(way)
            if clear:
                yield way, stance
            else:
                in_legs.append((way, stance))
        yield from in_legs

    def _ways_under(
        self, moment: FeetMoment, played: Sequence[tuple[Playback, Floats]]
    ) -> Iterator[tuple[Playback, Floats, bool]]:
        """The same, some of them twice, and whether arms are clear of the legs."""
        alive = [(self._posing(moment, posed), stance) for posed, stance in played]
        for it, stance in alive:
            for way in self._off_things(moment, self._made_way(it)):
                yield way, stance, way.upper is it.posed.upper or self._arms.are_clear(way.root, way.upper)
        for how in (GLIDES, STEPS):
            for it, stance in alive:
                for way in self._ways(it.on_planned_hips, how):
                    yield way, stance, self._arms.are_clear(way.root, way.upper)
        still = moment._replace(room=NOT_AT_ALL)
        for posed, stance in played:
            for waits in self._waiting(still, posed):
                waiting = posed._replace(root=waits)
                apart = waiting._replace(upper=self._arms.apart(waits, posed.upper))
                for way in (apart, *self._less_apart(waiting)):
                    yield way, stance, self._arms.are_clear(way.root, way.upper)

    def _waiting(self, still: FeetMoment, posed: Playback) -> Iterator[Floats]:
        """Root states (SHOWN,) of a pose on feet that wait; first, where one has to go up, on such as do only that."""
        waits = self._made(still._replace(dt=0.0), posed, STEPS).root
        if self._is_strained(waits, posed.upper):
            return
        if not self._footing.plain:
            steps, rises = self._made(still, posed, STEPS).root, waits.copy()
            rises[RISES:ROOT_STATE:2] = np.maximum(steps, waits)[RISES:ROOT_STATE:2]
            if np.abs(rises - waits).max() > _SAME:
                yield rises
        yield waits

    def _made_way(self, alive: Posing) -> Iterator[Playback]:
        """How a pose is shown where arms make way for legs, on hips that live and then on those planned: best first."""
        yield self._next(alive)
        still = alive.on_planned_hips
        if still is not alive:
            yield self._next(still)
        for how in (HOLDS, GLIDES):
            made, posed = still.made(how), still.posed
            yield posed._replace(root=made.root, upper=self._arms.apart(made.root, posed.upper, made.gaps))

    def _off_things(self, moment: FeetMoment, ways: Iterator[Playback]) -> Iterator[Playback]:
        """The same ways: where one comes so near to what stands that its skin could touch, others that do not first.

        Plans keep off what stands; hips that come down to feet, or live, are not where these have them.
        """
        near: list[tuple[float, Playback]] = []
        for way in ways:
            room = moment.room_above(way.root, way.upper)
            if room >= _SKIN and not near:
                yield way
            else:
                near.append((min(room, _SKIN), way))
        while near:
            best = 0
            for n, (room, _) in enumerate(near):
                best = n if room > near[best][0] + _FARTHER else best
            yield near.pop(best)[1]

    def _less_apart(self, pose: Playback, known: Gaps | None = None) -> Iterator[Playback]:
        """A pose whose arms leave the legs no more room than they must, if they are in them; and as it is."""
        upper = self._arms.barely_apart(pose.root, pose.upper, known)
        if upper is not pose.upper:
            yield pose._replace(upper=upper)
        yield pose

    def _all_ways(self, alive: Posing, order: tuple[int, int]) -> Iterator[tuple[Posing, Playback]]:
        """How a pose can be shown on feet that follow in two ways, on hips that live and then on those planned."""
        still = alive.on_planned_hips
        for it in (alive,) if still is alive else (alive, still):
            yield from ((it, pose) for how in order for pose in self._ways(it, how))

    def _ways(self, it: Posing, how: int) -> Iterator[Playback]:
        """How a pose can be shown on feet that follow in one of the ways: best first.

        On ground that is not plain there are more: on arms that make way for the legs or do not, and where feet glide
        they are raised slowly or hastily, or are at once where they were planned.
        """
        posed = it.posed
        if self._footing.plain:
            made = it.made(how)
            yield from self._less_apart(posed._replace(root=made.root), made.gaps)
            return
        as_planned = list[Playback]()
        for root in [it.made(how).root] if how != GLIDES else self._glides(it):
            upper = self._arms.apart(root, posed.upper)
            if upper is not posed.upper:
                as_planned += self._less_apart(posed._replace(root=root))
            yield posed._replace(root=root, upper=upper)
        yield from as_planned

    def _posing(self, moment: FeetMoment, posed: Playback) -> Posing:
        return Posing(moment, posed, self._followed)

    def _glides(self, it: Posing) -> Iterator[Floats]:
        """Root states (SHOWN,) of a pose on feet that glide where ground is not plain: best first."""
        moment, posed = it.moment, it.posed
        before, stood = moment.shown.root, self._stood(posed.root)
        yield it.made(GLIDES).root
        for root in islice(raised(before, stood, moment.dt), 1, None):
            yield self._made(moment, posed._replace(root=root), GLIDES).root
        at_once = gliding(self._gait, before, stood, _LONG)
        yield self._alive(moment._replace(room=NOT_AT_ALL), at_once, posed).root

    def _stood(self, root: Floats) -> Floats:
        """A root state (ROOT_STATE or more,) with what the feet of the walking cycle stand on (ROOT_STATE,)."""
        stood: Floats = self._footing.stood(root[None, :ROOT_STATE])[0][0]
        return stood

    def _clearest(self, it: Posing, room: Callable[[Floats], float]) -> Followed:
        """A pose on feet that step, if legs stay clear as they step on, by the `room` along root states (N, WITH_FEET).

        Else on feet that glide, but for the one that stands, as long as legs would stay clear if it went on from there:
        planned feet are proven free, those that stay behind them are not. Where nothing is as clear as that, a foot
        that stands glides only if that keeps off more.
        """
        ahead, under = it.moment.ahead, self._follower.under
        steps = it.made(STEPS)
        on_steps = room(steps_ahead(self._gait, steps.root[:WITH_FEET], ahead, _FORESEEN, self._own, under))
        if on_steps >= CLEAR:
            return steps
        held, glides = it.made(HOLDS), it.made(GLIDES)
        on_held, on_glides = (
            room(glides_ahead(self._gait, each.root[:WITH_FEET], ahead, _FORESEEN, under)) for each in (held, glides)
        )
        if on_held >= CLEAR:
            return held
        if on_steps >= on_glides - _NO_CLEARER and on_steps >= on_held:
            return steps
        return held if on_held >= max(on_glides - _NO_CLEARER, 0.0) else glides

    def _followed(self, moment: FeetMoment, posed: Playback, how: int) -> Followed:
        """A pose on feet that follow in one of the ways, with hips, chest and head that live."""
        if how == STEPS or self._footing.plain:
            return self._made(moment, posed, how)
        root = next(raised(moment.shown.root, self._stood(posed.root), moment.dt))
        return self._made(moment, posed._replace(root=root), how)

    def _made(self, moment: FeetMoment, posed: Playback, how: int) -> Followed:
        """The same, where the root tells already how high feet glide."""
        before, coming, root, upper = moment.shown.root, moment.ahead, posed.root, posed.upper
        return Followed(*followed(self._follower, before, root, upper, coming, moment.dt, moment.room, how))

    def _alive(self, moment: FeetMoment, root: Floats, posed: Playback) -> Playback:
        """A pose on a root with feet (WITH_FEET,), with hips, chest and head that live."""
        faces = float(posed.upper[_TWIST] + posed.upper[_HEAD_TURN])
        shown, dt = moment.shown.root, moment.dt
        return posed._replace(root=living(self._body, shown, root, dt, moment.room, moment.ahead, faces))

    def _is_strained(self, root: Floats, upper: Floats) -> bool:
        """Whether a foot that has waited lies so far behind that the hips would come far down to it."""
        lowering, state = upper[LOWERING - DofGroup.ROOT.size :][:1].copy(), root[None, :ROOT_STATE].copy()
        sinks = [lower_body(self._gait, rows, lowering)[1][0, 0] for rows in (root[None], state)]
        return bool(sinks[0] - sinks[1] > _STRAIN * self._gait.half_leg)
