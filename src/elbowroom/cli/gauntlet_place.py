"""What `elbowroom gauntlet` is told about a place whose furniture is moved."""

import hashlib
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from elbowroom.errors import InputError

if TYPE_CHECKING:
    from elbowroom.experiment.gauntlet.place.furnished import FurnishedPlace
    from elbowroom.world.places.options import PlaceOptions

PlaceFile = Annotated[
    Path | None,
    typer.Option("--place", help="Courses in the model of a place instead: its furniture, moved at random."),
]
Pieces = Annotated[
    int | None, typer.Option(help="Pieces of furniture beside each way there; made up if it has fewer. 8 if not said.")
]
_PIECES = 8


def chosen_place(
    place: Path | None, pieces: int | None, options: "PlaceOptions", *, shapes: bool
) -> "FurnishedPlace | None":
    """The place that is told of, None for courses of a level; raises `InputError` for what does not go together."""
    from elbowroom.world.places.options import PlaceOptions

    if place is None:
        if pieces is not None or options != PlaceOptions():
            raise InputError(
                "--pieces, --scale, --up, --ground, --drop and --passable are for the place of --place FILE"
            )
        return None
    if shapes:
        raise InputError(f"--shapes is for courses of a level, not for those of --place {place}: leave one out")
    from elbowroom.experiment.gauntlet.place.furnished import FurnishedPlace
    from elbowroom.formats.models.kinds import kind_by_name

    if kind_by_name(str(place)) is None:
        raise InputError(
            f"--place {place}: is no model of a place by its name: .glb, .gltf, .obj, .stl, .ply, .usd, .x3d, .wrl"
        )
    return FurnishedPlace(place, _digest(place), options, _PIECES if pieces is None else pieces)


def _digest(place: Path) -> str:
    try:
        with place.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError as error:
        raise InputError(f"{place}: cannot be read: {error.strerror}") from None
