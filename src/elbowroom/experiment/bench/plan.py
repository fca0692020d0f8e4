"""What a planning call costs, and how that grows with how far it looks and with what stands near."""

import gc
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from elbowroom.body.humanoid import Humanoid
from elbowroom.experiment.bench.plan_calls import PlanCall, crossing_calls
from elbowroom.experiment.bench.settings import PlanSettings
from elbowroom.experiment.crossing import start_for
from elbowroom.experiment.rehearsal import rehearse
from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.scene import Scene

_POST = 0.03  # metres, half the thickness of a post in the lane
_ASIDE = (0.42, 0.60)  # metres from the middle of the lane to a post: within reach of a swinging hand, and beyond
_LANE = (1.0, 4.5)  # metres along the lane in which posts stand


@dataclass(frozen=True)
class CallCosts:
    """The calls of some crossings together; milliseconds of processor time, and by the clock where it says so."""

    calls: int
    searched: int  # of these; the others were answered with the rest of an earlier plan
    median_ms: float
    p99_ms: float
    worst_ms: float
    median_clock_ms: float
    worst_clock_ms: float
    search_median_ms: float  # of the calls that searched, and
    median_checks: float  # theirs
    worst_checks: int
    found: float  # share of the calls

    @property
    def worst_to_median_checks(self) -> float:
        """How much more collision work the worst call has than the usual one of those that search."""
        return self.worst_checks / max(self.median_checks, 1.0)


@dataclass(frozen=True)
class PlanCallsReport:
    """All figures."""

    settings: PlanSettings
    calls: CallCosts
    elsewhere: CallCosts  # from the other starts together
    by_horizon: tuple[CallCosts, ...]
    by_obstacles: tuple[CallCosts, ...]

    def as_dict(self) -> dict[str, Any]:
        """Settings and figures."""
        return asdict(self) | {"worst_to_median_checks": self.calls.worst_to_median_checks}


def run(settings: PlanSettings, tick: Callable[[int], None] = lambda _: None) -> PlanCallsReport:
    """Cross the scene `rounds` times, then from other starts, for each horizon, and a lane for each number of posts."""
    humanoid, scene = Humanoid.default(), Scene.load(settings.scene)
    done = 0
    rehearse(humanoid)  # load what is compiled, as a session does before it begins
    list(crossing_calls(humanoid, scene, settings.key_frames))
    gc.freeze()  # as a server does: kernels and libraries are no garbage

    def measured(key_frames: int, *scenes: Scene) -> CallCosts:
        nonlocal done
        calls: list[PlanCall] = []
        for where in scenes:
            calls += crossing_calls(humanoid, where, key_frames)
            done += 1
            tick(done)
        return _costs(calls)

    elsewhere = [replace(scene, start=start_for(scene, seed)) for seed in range(1, settings.starts + 1)]
    return PlanCallsReport(
        settings,
        measured(settings.key_frames, *[scene] * settings.rounds),
        measured(settings.key_frames, *elsewhere),
        tuple(measured(horizon, scene) for horizon in settings.horizons),
        tuple(measured(settings.key_frames, lane(posts)) for posts in settings.obstacles),
    )


def amount(settings: PlanSettings) -> int:
    """How many crossings there will be."""
    return settings.rounds + settings.starts + len(settings.horizons) + len(settings.obstacles)


def lane(posts: int) -> Scene:
    """The empty scene with posts on both sides of the way, evenly spread, as tall as a man."""
    bare = Scene.load("empty")
    left = np.where(np.arange(posts) % 2 == 0, 1.0, -1.0)
    aside = np.where(np.arange(posts) % 4 < 2, *_ASIDE)
    centers = np.stack([left * aside, np.full(posts, 0.9), np.linspace(*_LANE, posts)], axis=1)
    turns, halves = np.tile(quaternion.IDENTITY, (posts, 1)), np.tile([_POST, 0.9, _POST], (posts, 1))
    names = tuple(f"post {i + 1}" for i in range(posts))
    return replace(bare, name=f"lane of {posts}", obstacles=Obstacles.boxes(centers, turns, halves, names))


def _costs(calls: Sequence[PlanCall]) -> CallCosts:
    times, waits = np.array([call[:2] for call in calls]).T
    checks, searched = np.array([call.checks for call in calls]), np.array([call.searched for call in calls])
    return CallCosts(
        calls=len(calls),
        searched=int(searched.sum()),
        median_ms=float(np.median(times)),
        p99_ms=float(np.percentile(times, 99)),
        worst_ms=float(times.max()),
        median_clock_ms=float(np.median(waits)),
        worst_clock_ms=float(waits.max()),
        search_median_ms=float(np.median(times[searched])),
        median_checks=float(np.median(checks[searched])),
        worst_checks=int(checks.max()),
        found=float(np.mean([call.found for call in calls])),
    )
