"""What the exact planner is told once."""

from dataclasses import dataclass

from elbowroom.body.dof import DofGroup

_LONE = 1.26  # a step between two pauses peaks at 1.25 times its mean speed (`curve`); bounding it takes a little more


@dataclass(frozen=True)
class ExactSettings:
    """How far the planner looks, how fast limbs may move, and what it prefers. Metres, radians, seconds."""

    look_ahead: float = 2.4  # seconds, whatever the size of the queue
    # The same where something else is wanted than before, until the next plan makes it longer; and on uneven ground.
    hurried_ahead: float = 1.65
    interval: float = 0.15  # seconds between key frames, for which posture sets are made in advance
    samples_share: float = 1.0  # of the postures that the table of groups takes from each clip
    margin: float = 0.008  # clearance of a posture around its key time
    motion_margin: float = 0.005  # clearance of the motion that is shown
    soon: float = 0.6  # seconds ahead until which less is asked for: what was free from afar stays free when it is near
    soon_share: float = 0.5  # of margin and skin, at this moment
    spare: float = 0.45  # seconds beyond the look-ahead, or within it on a way aside, in which a plan is kept
    revisited: float = 1.2  # seconds at the end of a plan that are searched anew with that; the rest is kept
    comfort: float = 0.05  # postures with less clearance cost more
    rounds: int = 18  # motions that may turn out to touch before a group gives up
    guided_rounds: int = 4  # answers of the joint step that may turn out to touch
    self_rounds: int = 6  # motions that may turn out to run into the body itself
    step_weight: float = 1.5  # of changing the distance from the goal, against that distance itself
    near_weight: float = 20.0  # of lacking comfort, for each square metre
    keeping: float = 0.02  # squared radians that another way must be better than the one being followed
    remember: bool = True  # what was found out for earlier plans; without it the same paths are found, only slower
    paces: tuple[float, ...] = (1.0, 0.6, 0.35, 0.2)  # shares of the wanted speed that are tried

    def samples_of(self, group: DofGroup) -> int:
        """The number of postures that are taken from each clip of a local group."""
        return max(1, round(self.samples_share * group.value.samples))

    @staticmethod
    def speed_of(group: DofGroup) -> float:
        """The greatest speed of a local group's shown motion, rad/s."""
        return group.value.speed

    @staticmethod
    def acceleration_of(group: DofGroup) -> float:
        """The greatest acceleration of a local group's shown motion, rad/s^2."""
        return group.value.acceleration

    @staticmethod
    def mean_speed_of(group: DofGroup) -> float:
        """The greatest speed of a local group from key frame to key frame, rad/s: of an edge."""
        return group.value.speed / _LONE
