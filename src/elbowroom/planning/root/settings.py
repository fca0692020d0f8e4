"""What legs can do."""

from dataclasses import dataclass


@dataclass(frozen=True)
class RootMotionSettings:
    """What the legs can do. Metres, radians, seconds."""

    walk_speed: float = 1.1
    run_speed: float = 2.2
    back_speed: float = 0.7
    strafe_speed: float = 0.6
    turn_rate: float = 2.5  # greatest heading rate
    acceleration: float = 2.0
    braking: float = 3.0
    turn_acceleration: float = 14.0
