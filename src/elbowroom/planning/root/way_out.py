"""Out of where there is no way on: a few short steps back, aside or round, to where the command leads on.

Hard by an obstacle a stride or a turn may have no room though there is plenty of it a step farther off. So places that
short steps lead to are looked at, the cheapest first as in Dijkstra's search, each reached by steps that are free with
a stop after each, until the commanded path from one, or an evasion, leads beyond where the avatar stands. How many are
looked at is bounded; who finds nothing stands.
"""

import heapq
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import count, islice
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import RootState
from elbowroom.planning.root.line.line import TravelLine
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.paths import RootPaths
from elbowroom.planning.root.plan import Pause, RootPlan, RootPlanKind
from elbowroom.planning.root.query import Asked

Floats = NDArray[np.float64]

_ASTRAY = 0.02  # metres, radians, and these by second: who is farther from a way out does not follow it
_LATE = 1.5  # times as long as the steps take, their walker may need for them: playback can be slower than the plan


@dataclass(frozen=True)
class WayOutSettings:
    """Which steps are tried, and how many. Metres, radians, seconds."""

    # Velocities forward and to the left, and heading rates, of the steps.
    steps: tuple[tuple[float, float, float], ...] = (
        *((-0.4, 0.0, 0.0), (0.0, 0.4, 0.0), (0.0, -0.4, 0.0), (0.4, 0.0, 0.0)),
        *((-0.3, 0.3, 0.0), (-0.3, -0.3, 0.0), (0.3, 0.3, 0.0), (0.3, -0.3, 0.0)),
        *((-0.15, 0.0, 0.0), (0.0, 0.15, 0.0), (0.0, -0.15, 0.0), (0.15, 0.0, 0.0)),
        *((-0.05, 0.0, 0.0), (0.0, 0.05, 0.0), (0.0, -0.05, 0.0)),
        *((0.0, 0.0, 0.9), (0.0, 0.0, -0.9)),
    )
    moving: int = 4  # key intervals until a step is braked
    length: int = 5  # key intervals until it has come to a stand
    roomy: float = 0.12  # clearance of the legs beyond which a place is as good as any
    crowded: float = 6.0  # seconds that each metre less counts for
    gain: float = 0.15  # metres by which the path from a place must lead beyond where the avatar stands
    most: int = 60  # places that are looked at; many are none
    free: int = 18  # of them, those that free steps lead to
    grids: int = 5  # roomy ones of these, from which an evasion is sought
    same: tuple[float, float] = (0.02, 0.2)  # metres and radians within which places are one


class WayOut(NamedTuple):
    """A way out that is being followed."""

    line: TravelLine  # that the command leads along
    path: RootPath  # the steps, and the way on from there
    length: int  # key intervals of the steps
    ahead: float  # metres along the line, where there was no way on
    tries: int  # ways out that have been taken from about there

    def left(self, asked: Asked) -> Floats | None:
        """Its states (n+1, 7) at the key times from now on, for who is on its steps; None for who is not, or later."""
        if asked.start_time - self.path.start_time > _LATE * self.length * self.path.interval:
            return None
        moments = self.path.start_time + self.path.interval * np.arange(0.0, self.length, 0.25)
        apart = np.abs(self.path.sample(moments) - asked.start.as_array())[:, :6].max(axis=1)
        nearest = int(apart.argmin())
        if apart[nearest] > _ASTRAY:
            return None
        return self.path.sample(moments[nearest] + asked.interval * np.arange(asked.horizon + 1.0))


class _Place(NamedTuple):
    """Where some steps end, the best first."""

    cost: float  # seconds
    number: int
    states: Floats  # (m+1, 7) of the steps
    roomy: bool = False  # whether legs are as far from everything as is liked

    @property
    def end(self) -> RootState:
        """The state that they end in."""
        return _state(self.states[-1])


class WayOutFinder:
    """Finds ways out for one humanoid in one scene; remembers nothing."""

    def __init__(self, settings: WayOutSettings, paths: RootPaths) -> None:
        self.settings, self._paths = settings, paths

    def ways(self, asked: Asked, line: TravelLine) -> Iterator[tuple[RootPlan, RootPath, int] | Pause]:
        """Ways out from where `asked` stands, to where its command leads on along `line`; the cheapest first.

        With each the whole path over the steps and on, and how many key intervals the steps take.
        """
        beyond = line.coordinates(asked.start.x, asked.start.z)[0] + self.settings.gain
        grids, before = self.settings.grids, self._paths.checks
        for place in islice(self._places(asked), self.settings.free):
            at, evading = asked._replace(start=place.end), place.roomy and grids > 0
            grids -= evading
            onward = (plan for plan in self._onward(at, line, evading=evading) if _leads_beyond(plan, line, beyond))
            plan, checks = next(onward, None), self._paths.checks - before
            before += checks
            yield Pause(checks) if plan is None else _joined(asked, place, plan._replace(checks=checks))

    def _places(self, asked: Asked) -> Iterator[_Place]:
        """Places that free steps lead to, the cheapest first; those beyond one are looked for when it was given."""
        s, here = self.settings, _Place(0.0, 0, asked.start.as_array()[None])
        numbers, seen, waiting = count(1), {self._name(here.states[-1])}, [here]
        for _ in range(s.most):
            if not waiting:
                return
            place = heapq.heappop(waiting)
            if place is not here:
                step = place.states[-s.length - 1 :]
                if not self._paths.is_free(asked._replace(start=_state(step[0]), horizon=s.length), step):
                    continue
                yield place
            for reached in self._beside(asked, place, numbers):
                name = self._name(reached.states[-1])
                if name not in seen:
                    seen.add(name)
                    heapq.heappush(waiting, reached)

    def _beside(self, asked: Asked, place: _Place, numbers: Iterator[int]) -> Iterator[_Place]:
        """The places that one step leads to from another, free or not."""
        s, at = self.settings, asked._replace(start=place.end, horizon=self.settings.length)
        steps = self._paths.short_steps(at, np.array(s.steps), s.moving)
        rooms = self._paths.rooms(at, steps[:, -1])
        walked = asked.interval * (len(place.states) - 1 + s.length)
        for number, step, room in zip(numbers, steps, rooms.tolist(), strict=False):
            cost = walked + s.crowded * max(s.roomy - room, 0.0)
            yield _Place(cost, number, np.vstack([place.states, step[1:]]), room >= s.roomy)

    def _name(self, state: Floats) -> tuple[int, ...]:
        near, turned = self.settings.same
        return tuple(np.round(state[:3] / (near, near, turned)).astype(int).tolist())

    def _onward(self, at: Asked, line: TravelLine, *, evading: bool) -> Iterator[RootPlan]:
        """The commanded path from a place, and evasions from it."""
        yield self._paths.travelled(at, line, 1.0)
        if evading:
            fine, axis = self._paths.evasions[0], self._paths.axis_ahead(at, line)
            for along, share in (
                [(line, 1.0)] if axis is None else [(line, 1.0), (axis, 1.0), (axis, fine.settings.short)]
            ):
                yield from (plan for plan, _ in self._paths.evaded(at, line, along, fine, None, share))


def _leads_beyond(plan: RootPlan, line: TravelLine, beyond: float) -> bool:
    """Whether a path leads farther than so many metres along a line."""
    x, z = plan.path.states[-1, :2].tolist()
    return plan.kind is not RootPlanKind.STOPPED and line.coordinates(x, z)[0] > beyond


def _joined(asked: Asked, place: _Place, onward: RootPlan) -> tuple[RootPlan, RootPath, int]:
    """A plan over the steps to a place and then on, with the whole path and the length of the steps."""
    path = RootPath(asked.start_time, asked.interval, np.vstack([place.states, onward.path.states[1:]]))
    lost = asked.horizon * asked.interval
    plan = onward.ended(path.until(asked.horizon), RootPlanKind.EVASION)._replace(lost=lost)
    return plan, path, len(place.states) - 1


def _state(row: Floats) -> RootState:
    return RootState(*row.tolist())
