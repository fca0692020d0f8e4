"""One walk through one course in a place: to its goal, by the way that the map knows."""

from collections.abc import Callable

import numpy as np

from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.experiment.gauntlet.place.course import PlaceCourse
from elbowroom.experiment.gauntlet.trial import TrialResult
from elbowroom.experiment.tour.leg import walk_to

NO_LEVEL = 0  # that results of courses in places have


def walk_place_course(
    controller: Controller, course: PlaceCourse, seen: Callable[[Frame], None] | None = None
) -> TrialResult:
    """Go to the goal of a course; `seen` is shown every frame."""
    frames = list[Frame]()

    def listen(frame: Frame, dt: float) -> None:
        del dt
        frames.append(frame)
        if seen is not None:
            seen(frame)

    leg, times = walk_to(controller, course.goal, course.limit, listen)
    touching = sum(frame.clearance < 0.0 for frame in frames)
    plans = {frame.plan.number: frame.plan.checks for frame in frames if frame.plan is not None}
    return TrialResult(
        level=NO_LEVEL,
        seed=course.seed,
        fingerprint=course.fingerprint,
        crossed=leg.arrived,
        straight=leg.arrived and leg.stuck_times == 0,
        stuck_times=leg.stuck_times,
        stopped=not leg.arrived and touching == 0,
        touching_frames=touching,
        least_clearance=leg.least_clearance,
        seconds=leg.seconds,
        limit=course.limit,
        frames=len(frames),
        collision_checks=len(frames) + sum(plans.values()),
        plan_ms=tuple(np.round(times.frame_ms[times.planned], 3).tolist()),
    )
