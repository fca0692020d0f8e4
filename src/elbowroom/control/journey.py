"""Going to a place: the commands that a user would give along the way, and when to give it up."""

import math
from dataclasses import replace
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import RootState
from elbowroom.planning.command import Command
from elbowroom.planning.navigation.backwards import Stretch, stretch_from
from elbowroom.planning.navigation.navigator import Navigator
from elbowroom.planning.navigation.way import NoWayError, Place, Spot, Way, apart, said
from elbowroom.planning.root.line.way_ahead import Corners, away_from, leg_at

Floats = NDArray[np.float64]

_FAR = 6.0  # metres along the way that are looked ahead
_ON_IT = 0.15  # metres from a leg of the way: one is on it
_THERE, _NEARLY = 0.15, 0.35  # metres to the goal: one has arrived; so has who gets no nearer
_NEARER = 0.15  # metres that count as progress
_PATIENCE, _STUCK_PATIENCE = 4.0, 1.2  # seconds without progress; the same where no way on is found
_PLANS = 6  # that have found none until then: where these are dear, not all has been tried so soon
_BACKS = 0.7  # seconds of stepping back at first; each time as much more
_AHEAD, _DISC = 0.45, 0.3  # metres to the middle of what is taken to be closed, and its radius
_TRIES = 6  # to get past what blocks the way
_PAST = 1.5  # metres along the way from there: one has got past


class JourneyState(Enum):
    """How it stands with a journey."""

    WALKING = "walking"  # it goes on
    ARRIVED = "arrived"  # who walks stands there
    GIVEN_UP = "given up"  # for the journey's `reason`
    TAKEN_OVER = "taken over"  # the user went elsewhere


class Journey:
    """One walk to a place."""

    def __init__(self, navigator: Navigator, way: Way, pace: Command) -> None:
        """`pace` says how fast: its `forward` and `run`."""
        self.state = JourneyState.WALKING  # how it stands with it
        self.reason = ""  # why it was given up
        self.way = way  # that is walked along
        self._navigator, self._pace = navigator, pace
        self._closed: list[tuple[Spot, float]] = []
        self._corners: list[Place] = []  # of the way that is walked along
        self._stretch = Stretch(False, way)  # of the way, that they lead along
        self._along: Corners = ()  # the same without heights
        self._leg = 0  # the number of the leg that was reached
        self._nearest, self._waited, self._plans, self._back = math.inf, 0.0, 0, 0.0
        self._tries, self._blocked = 0, math.inf  # metres that were left where one was last blocked

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

    def command(self, root: RootState, dt: float, *, stuck: bool, plans: int) -> Command:
        """What to do for the next `dt` seconds; `stuck` is what the last frame said, after so many `plans` in all."""
        found = self._next(root, dt, stuck=stuck, plans=plans)
        return replace(found, led=True, may_climb=self.way.climbs) if self.walking else found

    def _next(self, root: RootState, dt: float, *, stuck: bool, plans: int) -> Command:
        """The same, as somebody would steer."""
        here = float(root.x), float(root.height), float(root.z)
        away = apart(here, self.goal)
        if away < _THERE:
            self.state = JourneyState.ARRIVED
        elif self._back > 0.0:
            self._back -= dt
            return Command(forward=-self._forward)
        else:
            self._waited += dt
            self._watch(here, away, plans, stuck)
        if not self.walking:
            return Command()
        return self._onward(here)

    def _onward(self, here: Place) -> Command:
        """Along the same corners, until one has got off them and the next one has gone out of sight."""
        if not self._keeps_to_it(here):
            self._corners, self._leg = self._found(here), 0
            self._along = tuple((x, z) for x, _, z in self._corners)
        if len(self._corners) < 2:
            return Command()
        (x, z), (next_x, next_z) = self._along[:2]
        direction = math.atan2(next_x - x, next_z - z)
        return replace(self._pace, forward=self._forward, direction=direction, way=self._along)

    @property
    def _forward(self) -> float:
        """The share of full speed, negative where one goes backwards."""
        share = abs(self._pace.forward)
        return -share if self._stretch.backwards else share

    def _keeps_to_it(self, here: Place) -> bool:
        if len(self._corners) < 2:
            return False
        if self._stretch.way is not self.way and apart(here, self._corners[-1]) < _THERE:
            return False
        x, _, z = here
        self._leg = leg_at(self._along, x, z, self._leg)
        on_it = away_from(self._along, self._leg, x, z) < _ON_IT
        return on_it or self.way.sees(here, self._corners[self._leg + 1])

    def _found(self, here: Place) -> list[Place]:
        """The corners of the way from here, which is searched for where it is not known."""
        corners = self._next_corners(here)
        if len(corners) < 2:
            self._search(here)
            corners = self._next_corners(here) if self.walking else corners
        return [(x, height, z) for x, height, z in corners.tolist()]

    def _next_corners(self, here: Place) -> Floats:
        """The corners (m, 3) of the next stretch of the way."""
        self._stretch = stretch_from(self.way, here, backwards=self._stretch.backwards)
        return self._stretch.way.corners(here, _FAR)

    def _watch(self, here: Place, away: float, plans: int, stuck: bool) -> None:
        """Notice progress, or that there is none for long."""
        left = self.way.left(here)
        if left < self._nearest - _NEARER:
            if left < self._blocked - _PAST:
                self._tries = 0
            self._nearest, self._waited, self._plans = left, 0.0, plans
            return
        nearly = away < _NEARLY
        if self._waited < (_STUCK_PATIENCE if stuck and (nearly or plans - self._plans >= _PLANS) else _PATIENCE):
            return
        if nearly:
            self.state = JourneyState.ARRIVED
            return
        self._plans = plans
        self._get_past(here)

    def _get_past(self, here: Place) -> None:
        """Step back and try again, or, the next time, go round what blocks the way."""
        self._waited, self._tries, self._corners = 0.0, self._tries + 1, []
        self._blocked = self.way.left(here)
        if self._tries > _TRIES:
            self._give_up(f"the way is blocked at {said(here)}")
            return
        self._back = _BACKS * self._tries
        aim = self.way.aim(here, _FAR)
        if self._tries % 2 == 0 and aim is not None:
            away = max(apart(here, aim), _AHEAD)
            share = _AHEAD / away
            middle = here[0] + share * (aim[0] - here[0]), here[2] + share * (aim[2] - here[2])
            self._closed.append((middle, _DISC))
            try:
                self.way = self._navigator.again(self.way, here, self._closed)
            except NoWayError:
                self._closed.clear()  # there is no other way: this one again
            self._nearest = math.inf

    def _search(self, here: Place) -> None:
        """The way from somewhere else than one has thought."""
        try:
            self.way = self._navigator.again(self.way, here, self._closed)
        except NoWayError as error:
            if self._closed:  # it may be what is taken to be closed
                self._closed.clear()
                self._search(here)
            else:
                self._give_up(str(error))
        self._nearest = math.inf

    def _give_up(self, why: str) -> None:
        self.state, self.reason = JourneyState.GIVEN_UP, why
