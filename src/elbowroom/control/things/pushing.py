"""What is pushed about one avatar: it stays away from the body that is shown, and plans reckon with it."""

from collections.abc import Mapping

from elbowroom.body.root import HEIGHT, RISES, ROOT_STATE
from elbowroom.control.key_frame_queue import Playback
from elbowroom.control.shown.body_check import BodyCheck
from elbowroom.control.things.loose import Hand, Loose, Thing, at_rest
from elbowroom.world.obstacles.tracks.moving import Moving
from elbowroom.world.scene import Scene

_OVER = 0.1  # metres: a foot that is no higher above a thing stands on it, or goes over it


class Pushing:
    """The things that are loose in a scene, beside one avatar that is shown there."""

    def __init__(self, scene: Scene) -> None:
        """None is loose yet."""
        self._loose = Loose(scene)

    @property
    def things(self) -> Mapping[int, Thing]:
        """What was taken in hand, by its number among the scene's standing obstacles."""
        return self._loose.things

    @property
    def hand(self) -> Hand | None:
        """What is pushed now, and where to."""
        return self._loose.hand

    @property
    def moves(self) -> bool:
        """Whether any of it moves."""
        return self._loose.moves

    def scene_at(self, time: float) -> Scene:
        """The scene as it is at a time: what was pushed is where it is."""
        return self._loose.surroundings(time)

    def take(self, hand: Hand, check: BodyCheck, shown: Playback) -> Scene | None:
        """Push a thing; what stands still from now on, if the thing has become loose by that. Raises `InputError`."""
        soles = float(shown.root[HEIGHT] + shown.root[RISES:ROOT_STATE:2].max())

        def is_underfoot(thing: Thing) -> bool:
            there = at_rest([thing], 0.0)
            return thing.top < soles + _OVER and check.clearance_from(there, shown.root, shown.upper, 0.0) < _OVER

        return self._loose.scene() if self._loose.take(hand, is_underfoot) else None

    def let_go(self) -> None:
        """Push nothing any more."""
        self._loose.let_go()

    def rest(self, check: BodyCheck, time: float) -> None:
        """Let the things be where they are."""
        check.loose = self._loose.at_rest(time)

    def advance(self, check: BodyCheck, shown: Playback, time: float, dt: float) -> None:
        """Let them go on by `dt` seconds, away from the body that is shown."""
        if not len(self._loose):
            return

        def leaves_alone(thing: Moving, way: float) -> bool:
            first, last = thing.tracks[0].times.tolist()
            return check.leaves_alone(thing, (shown.root, shown.upper), (first, last), way)

        check.loose = self._loose.advance(time, dt, leaves_alone)

    def foreseen(self, check: BodyCheck, start: Playback, now: float, time: float) -> Moving:
        """Where they will be, for a plan that begins at `start` at a `time`."""

        def clear(thing: Moving) -> bool:
            return check.clearance_from(thing, start.root, start.upper, time) >= 0.0

        return self._loose.foreseen(now, time, clear)
