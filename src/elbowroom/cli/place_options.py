"""Options that say how the model of a place is read, the same in all commands that take one."""

from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from elbowroom.world.places.options import PlaceOptions

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
