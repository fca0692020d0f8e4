"""How courses are walked."""

from dataclasses import dataclass

from elbowroom.planning.names import DEFAULT_PLANNER


@dataclass(frozen=True)
class TrialSettings:
    """How courses are walked."""

    planner: str = DEFAULT_PLANNER
    queue_size: int = 5
