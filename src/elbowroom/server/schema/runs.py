"""A recorded run on its way to a page.

It travels as the length of the JSON of a `Run` (uint32, little-endian), that JSON, and its pose frames one after the
other.
"""

from dataclasses import dataclass

from elbowroom.server.schema.picture import AvatarMessage, SceneMessage


@dataclass(frozen=True)
class Run:
    """What stands before the pose frames of a run: its place and its avatar, how many frames there are and how long."""

    name: str  # of the file
    scene: SceneMessage
    avatar: AvatarMessage
    planner: str
    stand_in: str  # the avatar that was recorded, where another one stands in for it; else ""
    note: str  # what is missing of the recording; else ""
    frames: int
    frame_bytes: int
