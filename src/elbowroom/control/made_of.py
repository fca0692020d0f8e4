"""What a controller is made of: a program may hand it anything."""

from elbowroom.body.humanoid import Humanoid
from elbowroom.clips.motion_set import MotionSet
from elbowroom.errors import InputError, in_a_line
from elbowroom.world.scene import Scene


def check_made_of(humanoid: object, scene: object, motions: object) -> None:
    """Raises `InputError` for what a program takes for one of these."""
    for name, given, kind, maker in (
        ("humanoid", humanoid, Humanoid, "Humanoid.load"),
        ("scene", scene, Scene, "Scene.load"),
        ("motions", motions, MotionSet, "motions_of"),
    ):
        if not isinstance(given, kind):
            raise InputError(f"{name}: {in_a_line(given)} is no {kind.__name__}: {maker} makes one")
