"""What the exact planner is told once."""

from dataclasses import dataclass


@dataclass(frozen=True)
class ExactSettings:
    """How far the planner looks, how fast limbs may move, and what it prefers. Metres, radians, seconds."""

    look_ahead: float = 2.4  # seconds, whatever the size of the queue
    interval: float = 0.15  # seconds between key frames, for which posture sets are made in advance
    waist_samples: int = 6  # postures taken from each clip
    arm_samples: int = 10
    waist_speed: float = 2.7  # rad/s, over its components together: a quick bend, turn or crouch
    arm_speed: float = 5.0  # rad/s, over the four components together: a reach at ease is half as fast
    # What the shown curve may ask for, over all components together. People move their joints nearly with minimum jerk
    # (T. Flash & N. Hogan, J. Neuroscience 5, 1985), where a way D in the time T peaks at 1.9 D/T and 5.8 D/T^2.
    waist_acceleration: float = 60.0  # rad/s^2: half a radian in 0.22 s
    arm_acceleration: float = 150.0  # rad/s^2: a radian in 0.2 s, as in a reach as fast as can be
    margin: float = 0.008  # clearance of a posture around its key time
    skin: float = 0.005  # clearance of the motion that is shown
    soon: float = 0.6  # seconds ahead until which less is asked for: what was free from afar stays free when it is near
    soon_share: float = 0.5  # of margin and skin, at this moment
    spare: float = 0.45  # seconds that a walk which goes on as planned is planned beyond the look-ahead
    revisited: float = 1.2  # seconds at the end of a plan that are searched anew with that; the rest is kept
    comfort: float = 0.05  # postures with less clearance cost more
    rounds: int = 16  # motions that may turn out to touch before a group gives up
    guided_rounds: int = 4  # answers of the joint step that may turn out to touch
    self_rounds: int = 3  # motions that may turn out to run into the body itself
    refinements: int = 2  # times in a plan that postures are added where it is blocked
    step_weight: float = 1.5  # of changing the distance from the goal, against that distance itself
    near_weight: float = 20.0  # of lacking comfort, for each square metre
    keeping: float = 0.02  # squared radians that another way must be better than the one being followed
    paces: tuple[float, ...] = (1.0, 0.6, 0.35, 0.2)  # shares of the wanted speed that are tried
