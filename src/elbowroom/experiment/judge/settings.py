"""What the judge looks at, and what it calls a contact."""

from dataclasses import dataclass

from elbowroom.errors import InputError

_HIGHEST_RATE = 10_000.0  # poses a second


@dataclass(frozen=True)
class JudgeSettings:
    """What the judge looks at, and what it calls a contact; raises `InputError` for a rate out of range."""

    rate: float = 240.0  # poses a second
    mesh: bool = True  # where the avatar has one
    capsule_tolerance: float = 1e-5  # metres inside an obstacle that are no contact: rounding
    mesh_tolerance: float = 1e-5  # metres, the same for the mesh
    self_tolerance: float = 0.02  # metres that parts of the body may be deeper in each other than in the natural walk

    def __post_init__(self) -> None:
        if not 1.0 <= self.rate <= _HIGHEST_RATE:
            raise InputError(f"rate: {self.rate:g} is not between 1 and {_HIGHEST_RATE:g} poses a second")
