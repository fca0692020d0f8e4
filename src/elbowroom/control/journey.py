"""Going to a place: the commands that a user would give along the way, and when to give it up."""

import math
from dataclasses import replace
from enum import Enum

from elbowroom.body.root import RootState
from elbowroom.planning.command import Command
from elbowroom.planning.navigation.navigator import Navigator
from elbowroom.planning.navigation.way import NoWayError, Place, Spot, Way, apart, said

_FAR = 6.0  # metres along the way that are looked ahead
_CORNER = 0.5  # metres before a place that one walks to at which the next one is looked for
_STRAYED = math.radians(4.0)  # by which the aim moves aside before another direction is asked for
_THERE, _NEARLY = 0.15, 0.35  # metres to the goal: one has arrived; so has who gets no nearer
_SLOWS, _SLOWEST = 0.8, 0.25  # metres before the goal from which on one goes slower; share of the pace
_NEARER = 0.15  # metres that count as progress
_PATIENCE, _STUCK_PATIENCE = 4.0, 1.2  # seconds without progress; the same where no way on is found
_BACKS = 0.7  # seconds of stepping back
_AHEAD, _DISC = 0.45, 0.3  # metres to the middle of what is taken to be closed, and its radius
_TRIES = 6  # to get past what blocks the way
_PAST = 1.5  # metres from there: one has got past


class JourneyState(Enum):
    """How it stands with a journey."""

    WALKING = "walking"
    ARRIVED = "arrived"
    GIVEN_UP = "given up"
    TAKEN_OVER = "taken over"  # the user went elsewhere


class Journey:
    """One walk to a place."""

    def __init__(self, navigator: Navigator, way: Way, pace: Command) -> None:
        """`pace` says how fast: its `forward` and `run`."""
        self.state = JourneyState.WALKING
        self.reason = ""  # why it was given up
        self.way = way
        self._navigator, self._pace = navigator, pace
        self._closed: list[tuple[Spot, float]] = []
        self._aim: Place | None = None
        self._direction: float | None = None
        self._nearest, self._waited, self._back = math.inf, 0.0, 0.0
        self._tries, self._blocked_at = 0, way.goal

    @property
    def goal(self) -> Place:
        """Where to: x, height, z."""
        return self.way.goal

    @property
    def walking(self) -> bool:
        """Whether it goes on."""
        return self.state is JourneyState.WALKING

    def take_over(self) -> None:
        """The user goes elsewhere."""
        if self.walking:
            self.state = JourneyState.TAKEN_OVER

    def command(self, root: RootState, dt: float, *, stuck: bool) -> Command:
        """What to do for the next `dt` seconds; `stuck` is what the last frame said."""
        here = float(root.x), float(root.height), float(root.z)
        away = apart(here, self.goal)
        if away < _THERE:
            self.state = JourneyState.ARRIVED
        elif self._back > 0.0:
            self._back -= dt
            return Command(forward=-abs(self._pace.forward))
        else:
            self._watch(here, away, dt, stuck)
        if not self.walking:
            return Command()
        return self._onward(here, away)

    def _onward(self, here: Place, away: float) -> Command:
        aim = self._next_aim(here)
        if aim is None:
            return Command()
        wanted = math.atan2(aim[0] - here[0], aim[2] - here[2])
        if self._direction is None or abs(math.remainder(wanted - self._direction, math.tau)) > _STRAYED:
            self._direction = wanted
        share = min(max(away / _SLOWS, _SLOWEST), 1.0) if apart(aim, self.goal) < _THERE else 1.0
        return replace(self._pace, forward=share * self._pace.forward, direction=self._direction)

    def _next_aim(self, here: Place) -> Place | None:
        """Where to walk straight to: the same place until one is near it, or it has gone out of sight."""
        if self._aim is not None and apart(here, self._aim) > _CORNER and self.way.sees(here, self._aim):
            return self._aim
        self._aim = self.way.aim(here, _FAR)
        if self._aim is None:
            self._search(here)
            self._aim = self.way.aim(here, _FAR) if self.walking else None
        return self._aim

    def _watch(self, here: Place, away: float, dt: float, stuck: bool) -> None:
        """Notice progress, or that there is none for long."""
        left = self.way.left(here)
        if left < self._nearest - _NEARER:
            if apart(here, self._blocked_at) > _PAST:
                self._tries = 0
            self._nearest, self._waited = left, 0.0
            return
        self._waited += dt
        if self._waited < (_STUCK_PATIENCE if stuck else _PATIENCE):
            return
        if away < _NEARLY:
            self.state = JourneyState.ARRIVED
            return
        self._get_past(here)

    def _get_past(self, here: Place) -> None:
        """Step back and try again, or, the next time, go round what blocks the way."""
        self._waited, self._tries, self._direction = 0.0, self._tries + 1, None
        self._aim = None
        self._blocked_at = here
        if self._tries > _TRIES:
            self._give_up(f"the way is blocked at {said(here)}")
            return
        self._back = _BACKS
        aim = self.way.aim(here, _FAR)
        if self._tries % 2 == 0 and aim is not None:
            away = max(apart(here, aim), _AHEAD)
            share = _AHEAD / away
            middle = here[0] + share * (aim[0] - here[0]), here[2] + share * (aim[2] - here[2])
            self._closed.append((middle, _DISC))
            try:
                self.way = self._navigator.find(here, self.goal, self._closed)
            except NoWayError:
                self._closed.clear()  # there is no other way: this one again
            self._nearest = math.inf

    def _search(self, here: Place) -> None:
        """The way from somewhere else than one has thought."""
        try:
            self.way = self._navigator.find(here, self.goal, self._closed)
        except NoWayError as error:
            self._give_up(str(error))
        self._nearest = math.inf

    def _give_up(self, why: str) -> None:
        self.state, self.reason = JourneyState.GIVEN_UP, why
