"""One walk to one place, as fast as it can be computed."""

import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.control.controller import FORWARD, Controller
from elbowroom.control.journey import JourneyState
from elbowroom.experiment.crossing import DT
from elbowroom.experiment.listener import Listener
from elbowroom.planning.command import Command
from elbowroom.planning.navigation.way import NoWayError, Place, Spot
from elbowroom.planning.root.pace import at_speed

NO_WAY, OUT_OF_TIME = "no way", "out of time"


@dataclass(frozen=True)
class Leg:
    """How a walk to one place went."""

    target: Place | Spot
    outcome: str  # "arrived", "given up", `NO_WAY` or `OUT_OF_TIME`
    reason: str  # why it was given up; else empty
    place: Place  # where it ended
    way_m: float  # metres along the way that was found first, more where it is narrow; 0 where there was none
    seconds: float
    stuck_times: int
    stuck_s: float  # seconds
    least_clearance: float  # metres, over its frames

    @property
    def arrived(self) -> bool:
        """Whether it led there."""
        return self.outcome == JourneyState.ARRIVED.value


@dataclass(frozen=True, eq=False)
class LegTimes:
    """What it cost to compute."""

    find_ms: float  # the way
    frame_ms: NDArray[np.float64]  # (frames,)
    frame_cpu_ms: NDArray[np.float64]  # (frames,) the same in processor time, whatever else the machine does
    planned: NDArray[np.bool_]  # (frames,) which of these planned


def walk_to(
    controller: Controller, target: Place | Spot, limit: float, listener: Listener | None = None
) -> tuple[Leg, LegTimes]:
    """Go to a place and stand there, or give up after `limit` seconds; `listener` hears of every step."""
    frame = controller.step(Command(), 0.0)
    began, started = time.perf_counter(), frame.time
    try:
        journey = controller.goto(target, at_speed(FORWARD, controller.motions.style.speed))
    except NoWayError as error:
        here = _here(controller)
        none = np.empty(0)
        leg = Leg(target, NO_WAY, str(error), here, 0.0, 0.0, 0, 0.0, round(frame.clearance, 6))
        return leg, LegTimes(1e3 * (time.perf_counter() - began), none, none, np.empty(0, np.bool_))
    found = time.perf_counter() - began
    way_m = journey.way.left(_here(controller))
    costs, processor, planned = list[float](), list[float](), list[bool]()
    stuck_times, stuck_frames, clearance = 0, 0, frame.clearance
    while (journey.walking or not controller.stands) and frame.time - started < limit:
        before, began, used = frame, time.perf_counter(), time.process_time()
        frame = controller.step(Command(), DT)
        costs.append(time.perf_counter() - began)
        processor.append(time.process_time() - used)
        planned.append(frame.plan is not before.plan)
        stuck_times += frame.stuck and not before.stuck
        stuck_frames += frame.stuck
        clearance = min(clearance, frame.clearance)
        if listener is not None:
            listener(frame, DT)
    outcome = OUT_OF_TIME if journey.walking else journey.state.value
    leg = Leg(
        target=target,
        outcome=outcome,
        reason=journey.reason or (f"{limit:g} s were not enough" if journey.walking else ""),
        place=_here(controller),
        way_m=round(way_m, 2),
        seconds=round(frame.time - started, 3),
        stuck_times=stuck_times,
        stuck_s=round(stuck_frames * DT, 3),
        least_clearance=round(float(clearance), 6),
    )
    return leg, LegTimes(1e3 * found, 1e3 * np.array(costs), 1e3 * np.array(processor), np.array(planned, np.bool_))


def _here(controller: Controller) -> Place:
    root = controller.root
    return round(root.x, 3), round(root.height, 3), round(root.z, 3)
