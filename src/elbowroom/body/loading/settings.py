"""How an avatar file is to be read, where the user wants it otherwise than by itself."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from elbowroom.errors import InputError

SHORTEST, TALLEST = 0.3, 3.0  # metres


@dataclass(frozen=True)
class LoadSettings:
    """Options of `Humanoid.load`; raises `InputError` for a height that no humanoid has."""

    # A JSON file, or the node of each bone: its name, its number, or None for none.
    bones: Path | Mapping[str, str | int | None] | None = None  # None: those of `FILE.bones.json`, if there is one
    include_hair: bool = False  # hair, skirts and the like belong to the collision body too
    height: float | None = None  # metres from the ground to the crown; None: as the file has it

    def __post_init__(self) -> None:
        if self.height is not None and not SHORTEST <= self.height <= TALLEST:
            raise InputError(f"height: {self.height:g} m is not between {SHORTEST} and {TALLEST} m")
