"""How fast certificate motions may be: clearly below what people do without hurry."""

from dataclasses import dataclass

WALK_SPEED = 1.1  # m/s, of the avatar at full stick: what a passage must be feasible at


@dataclass(frozen=True)
class HumanSpeeds:
    """Greatest speed and acceleration of a group's joints together (the norm over its components), walking at 1.1 m/s.

    Waist: healthy people flex the lumbar spine alone at more than 1 rad/s when asked to move fast (W. S. Marras &
    P. E. Wongsam, Arch. Phys. Med. Rehabil. 67 (1986)); bending here is shared by spine and hips. Arm: joint speeds of
    unhurried reaching (P. Morasso, Exp. Brain Res. 42 (1981)), which moves shoulder and elbow at 2 to 3 rad/s.
    """

    waist: float = 1.5  # rad/s
    arm: float = 2.2  # rad/s
    waist_acceleration: float = 8.0  # rad/s^2
    arm_acceleration: float = 14.0  # rad/s^2
