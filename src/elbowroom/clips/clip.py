"""A recorded clip: one motion of a file, its figure recognised."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from elbowroom.clips.body_motion import BodyMotion
from elbowroom.clips.dodge import dodge_clips
from elbowroom.clips.motion_set import STOCK, MotionSet
from elbowroom.clips.planning_motion import PlanningMotion, planning_motion
from elbowroom.clips.style import PLAIN_STYLE, Style
from elbowroom.clips.swing import Swing, swing_of
from elbowroom.clips.take_figure import TakeFigure
from elbowroom.clips.told import Told


@dataclass(frozen=True, eq=False)
class Clip:
    """One motion of a BVH, glTF or VRMA file."""

    name: str  # within its file
    file: str  # its name
    format: str  # "BVH", "glTF 2.0", "VRM animation 1.0"
    frames: int  # in the file
    figure: TakeFigure  # whose motion it is, as it was recognised
    motion: BodyMotion  # the figure's bones over time

    @classmethod
    def load(cls, reference: str | Path, told: Told | None = None) -> "Clip":
        """Read `FILE` or `FILE#CLIP`, for a file that holds several.

        Raises `InputError` if it cannot be read, or holds no motion of a humanoid.
        """
        from elbowroom.clips.files import open_motion
        from elbowroom.clips.reference import split_reference

        path, name = split_reference(reference)
        return open_motion(path, told).clip(name)

    @property
    def place(self) -> str:
        """File and clip, for messages and lists."""
        return self.file if self.format == "BVH" else f"{self.file}#{self.name}"

    @property
    def fps(self) -> float:
        """Frames a second."""
        return 1.0 / self.motion.frame_time

    @cached_property
    def planning(self) -> PlanningMotion:
        """What planning keeps of the motion."""
        return planning_motion(self.motion)

    @cached_property
    def swing(self) -> Swing:
        """Its mean stride; raises `InputError` if nobody walks in it."""
        return swing_of(self.planning, self.place)


def motions_of(swing: Clip | None = None, dodge: tuple[Clip, ...] = (), style: Style = PLAIN_STYLE) -> MotionSet:
    """The motions of an avatar that walks like one clip, or in a style, and has learnt to do what others show.

    Raises `InputError` if nobody walks in the clip for the swing.
    """
    if swing is None and not dodge and style is PLAIN_STYLE:
        return STOCK
    return MotionSet(
        None if swing is None else swing.swing,
        tuple(part for clip in dodge for part in dodge_clips(clip.planning)),
        style,
    )
