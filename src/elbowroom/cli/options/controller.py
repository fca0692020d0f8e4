"""Who walks for a command: its avatar is read before kernels are compiled, so a damaged one is told at once."""

from pathlib import Path
from typing import TYPE_CHECKING

from elbowroom.cli.options.avatar import chosen_avatar
from elbowroom.cli.telling.first_run import compile_first
from elbowroom.cli.telling.output import progress_bar
from elbowroom.cli.telling.spoken import said

if TYPE_CHECKING:
    from elbowroom.body.loading.settings import LoadSettings
    from elbowroom.clips.motion_set import MotionSet
    from elbowroom.control.controller import Controller
    from elbowroom.experiment.crossing_settings import CrossingSettings
    from elbowroom.world.scene import Scene


def chosen_controller(
    avatar: Path | None,
    reading: "LoadSettings",
    place: "Scene",
    settings: "CrossingSettings",
    motions: "MotionSet",
    *,
    quiet: bool,
) -> "Controller":
    """The controller of the avatar that the options ask for in a place, its kernels loaded; raises `InputError`."""
    from elbowroom.experiment.crossing import controller_for, warm_up

    with progress_bar(said("Opening the avatar"), None, quiet):
        humanoid = chosen_avatar(avatar, reading)
    compile_first(quiet=quiet)
    with progress_bar(said("Opening the avatar"), None, quiet):
        controller = controller_for(humanoid, place, settings, motions)
        warm_up(controller)
    return controller
