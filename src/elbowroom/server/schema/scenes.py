"""What the server says of scenes that pages build."""

from dataclasses import dataclass


@dataclass(frozen=True)
class UnseenWalk:
    """The answer to a scene that was posted to /api/walks: how an avatar fared that walked it with nobody looking."""

    decided: bool  # False where the time for it was over before
    passed: bool  # through the finish
    stuck: int  # times
    seconds: float  # of simulated time until the finish, or until it was given up
    x: float  # where the avatar was then
    z: float
