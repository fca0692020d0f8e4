"""Options that say how the model of a place is read, the same in all commands that take one."""

from typing import TYPE_CHECKING, Annotated

import typer

from elbowroom.cli.telling.output import progress_bar

if TYPE_CHECKING:
    from elbowroom.world.places.options import PlaceOptions
    from elbowroom.world.scene import Scene

Scale = Annotated[float | None, typer.Option("--scale", help="Metres in a unit of the place's file, as 0.01.")]
UpAxis = Annotated[str | None, typer.Option("--up", help="The axis that points up in the file: y, z, -x, ...")]
GroundHeight = Annotated[
    float | None, typer.Option("--ground", help="Height of the floor to walk on, metres; else it is found.")
]
Drop = Annotated[
    list[str] | None,
    typer.Option("--drop", help="Leave out what has such a name, as 'IfcDoor_*'; may be repeated.", metavar="PATTERN"),
]
Passable = Annotated[
    list[str] | None,
    typer.Option("--passable", help="Show it, and let one walk through it; may be repeated.", metavar="PATTERN"),
]


def place_options(
    scale: float | None, up: str | None, ground: float | None, drop: list[str] | None, passable: list[str] | None
) -> "PlaceOptions":
    """What the options say about a place; raises `InputError`."""
    from elbowroom.world.places.options import PlaceOptions

    return PlaceOptions(
        scale, None if up is None else up.lower().lstrip("+"), ground, tuple(drop or ()), tuple(passable or ())
    )


def open_scene(name: str, options: "PlaceOptions", quiet: bool) -> "Scene":
    """The scene of this name, or in this file, read with progress; raises `InputError`."""
    from elbowroom.experiment.gauntlet.scenes import load_scene

    with progress_bar("Opening the scene", 1.0, quiet) as bar:
        return load_scene(name, options, lambda what, share: bar.move(share, what))


def is_model(scene: str) -> bool:
    """Whether a scene is named by the file of a model."""
    from elbowroom.formats.models.kinds import kind_by_name

    return kind_by_name(scene) is not None
