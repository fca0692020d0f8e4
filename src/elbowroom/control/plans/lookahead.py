"""How far ahead a controller has plans made, and where."""

from dataclasses import dataclass

from elbowroom.control.plans.desk import PlanningDesk
from elbowroom.control.settings import ControlSettings


@dataclass(frozen=True)
class Lookahead:
    """How far ahead plans lead, in which steps, and who makes them."""

    queue_size: int = ControlSettings.queue_size  # |Q|, key frames; 2 to 32
    interval: float = ControlSettings.interval  # T_interval, seconds between key frames; 0.05 to 1
    desk: PlanningDesk | None = None  # None: they are made at once, in the same turn


STOCK_LOOKAHEAD = Lookahead()
