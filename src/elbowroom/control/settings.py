"""What a controller is told once."""

from dataclasses import dataclass

from elbowroom.control.handed_over import is_number, is_whole
from elbowroom.errors import InputError
from elbowroom.planning.names import DEFAULT_PLANNER, check_planner

QUEUE_SIZES = range(2, 33)  # key frames; the paper has 3 to 7


def check_queue_size(size: int) -> None:
    """Raises `InputError` if a key-frame queue cannot hold so many."""
    if size not in QUEUE_SIZES:
        limits = f"{QUEUE_SIZES.start} to {QUEUE_SIZES.stop - 1}"
        raise InputError(f"queue size: {size} is not a whole number from {limits} key frames")


@dataclass(frozen=True)
class ControlSettings:
    """The parameters of the control loop; the paper varies the queue size from 3 to 7."""

    planner: str = DEFAULT_PLANNER  # how upper-body motion is searched
    queue_size: int = 5  # |Q|, key frames planned ahead
    interval: float = 0.15  # T_interval, seconds between key frames
    seed: int = 0  # of all chance in planning
    assist: bool = True  # off: the canned walk, touching what it touches

    def __post_init__(self) -> None:
        check_planner(self.planner)
        check_queue_size(self.queue_size)
        if not (is_number(self.interval) and 0.05 <= self.interval <= 1.0):
            raise InputError(f"interval: {self.interval} is not between 0.05 and 1 seconds")
        if not is_whole(self.seed):
            raise InputError(f"seed: {self.seed} is no whole number")
        if self.seed < 0:
            raise InputError(f"seed: {self.seed} is negative")
