"""What the root planner is told once, and what it hands back."""

from collections.abc import Callable
from dataclasses import dataclass, field
from enum import Enum
from typing import NamedTuple

from elbowroom.planning.root.evasion.evasion import WIDE, EvasionSettings
from elbowroom.planning.root.line.route import RouteSettings
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.settings import RootMotionSettings


class RootPlanKind(Enum):
    """How a root path answers its command."""

    STRAIGHT = "straight"  # as commanded
    EVASION = "evasion"  # aside of the line of travel, or with the body turned
    DETOUR = "detour"  # round an obstacle, at full speed
    SHORTENED = "shortened"  # slower than commanded, or ending early
    STOPPED = "stopped"  # no path on


@dataclass(frozen=True)
class RootPlannerSettings:
    """How far the root planner looks ahead and how close it goes. Metres, seconds."""

    motion: RootMotionSettings = field(default_factory=RootMotionSettings)
    route: RouteSettings = field(default_factory=RouteSettings)
    evasion: EvasionSettings = field(default_factory=EvasionSettings)
    wide: EvasionSettings = WIDE
    wide_from: float = 0.3  # seconds lost by what is known, from which on wide detours are thought of
    sight: float = 3.2  # how far ahead the route is checked, at least as far as one gets within the plan
    beyond: float = 0.5  # and so much farther
    widest_detour: float = 1.6  # how far from the line of travel a detour may lead
    worth_it: float = 0.4  # progress beyond that of the straight route for which a detour is taken
    worth_going_round: float = 0.6  # metres more that are walked so as not to go through a gap with turned shoulders
    going_round: tuple[float, float] = (0.20, 0.08)  # the search for that, as those for a detour
    # Searches for a detour, in turn: the clearance that it must have, and the cells of the map.
    searches: tuple[tuple[float, float], ...] = ((0.10, 0.08), (0.02, 0.08), (0.003, 0.04))
    margin: float = 0.003  # clearance of the straight route
    skin: float = 0.003  # clearance that posed legs keep along a path
    spacing: float = 0.0125  # seconds between checked states
    untroubled: float = 0.15  # seconds lost below which nothing else is thought of
    dead_end: float = 2.0  # seconds that a route costs that ends before an obstacle
    aside_cost: float = 0.5  # seconds lost for each metre beside the line, and
    turned_cost: float = 0.15  # for each radian that the body is turned, over the whole path
    polite: float = 0.15  # metres that are kept from what moves
    wrong_side: float = 2.0  # seconds lost for each metre to the left of the line, where something moves
    crowded: float = 4.0  # seconds that a path costs for each metre less
    # Velocities forward and to the left with which to step out of the way of what moves, as they are liked.
    steps_aside: tuple[tuple[float, float], ...] = (
        *((-0.7, 0.0), (0.0, 0.6), (0.0, -0.6), (-0.5, 0.45), (-0.5, -0.45)),
        *((1.1, 0.0), (0.8, 0.5), (0.8, -0.5)),
    )
    # The same where none of these has a first step: steps so short that knees and heels stay where they are.
    creeping: tuple[float, ...] = (0.05, 0.02, 0.01)
    slower: tuple[float, ...] = (1.0, 0.6, 0.35, 0.2, 0.1)  # shares of the wanted speed that are tried


class RootPlan(NamedTuple):
    """A root path and how it came about."""

    path: RootPath
    kind: RootPlanKind
    goal: tuple[float, float]  # x, z of the short-term goal: where the checked route ends
    checks: int  # postures and places whose clearance was computed
    nanoseconds: int
    lost: float = 0.0  # seconds that it costs against a walk as commanded, evasions and turns included
    beside: bool = False  # whether it leads round a gap that one could go through
    free: bool = True  # whether nothing that moves comes into it
    pace: float = 0.0  # share of the wanted speed at which it is walked on to its end; 0 where it is not

    def along(self, path: RootPath) -> "RootPlan":
        """The same plan on another path."""
        return self._replace(path=path)

    def ended(self, path: RootPath, kind: RootPlanKind = RootPlanKind.SHORTENED) -> "RootPlan":
        """The same plan on a path that is not walked on as wanted to its end."""
        return self._replace(path=path, kind=kind, pace=0.0)

    def going_on(self, path: RootPath) -> "RootPlan":
        """The same plan on a path for which nothing was searched any more."""
        return self._replace(path=path, checks=0, nanoseconds=0)


class Pause(NamedTuple):
    """Nothing was found yet: whoever has waited long enough can leave, and come back for the rest."""

    checks: int  # postures and places whose clearance was computed since the last offer or pause


def never(checks: int) -> bool:
    """Who is never tired of waiting, however much was looked at."""
    del checks
    return False


class Patience(NamedTuple):
    """How long whoever asks for paths is willing to wait for more of them."""

    grids: int = 4  # in so many evasions are looked for
    enough: Callable[[int], bool] = never  # asked in each `Pause`, with its checks: whether that will do for now
