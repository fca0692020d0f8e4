"""The options by which commands choose an avatar."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from elbowroom.body.humanoid import Humanoid
    from elbowroom.body.loading.settings import LoadSettings

Avatar = Annotated[Path | None, typer.Option(help="A VRM, glTF or H-Anim humanoid instead of the stock avatar.")]
Bones = Annotated[Path | None, typer.Option(help="JSON that names the nodes of the avatar's bones.")]
Height = Annotated[float | None, typer.Option(help="Metres to the avatar's crown, instead of its file's own.")]
IncludeHair = Annotated[bool, typer.Option("--include-hair", help="Count hair, skirts and the like as its body.")]


def settings_by(bones: Path | None, height: float | None, include_hair: bool) -> "LoadSettings":
    """How the options say that an avatar is to be read; raises `InputError`."""
    from elbowroom.body.loading.settings import LoadSettings

    return LoadSettings(bones, include_hair, height)


def chosen_avatar(avatar: Path | None, settings: "LoadSettings") -> "Humanoid":
    """The avatar that the options ask for; raises `InputError`."""
    from elbowroom.body.humanoid import Humanoid
    from elbowroom.body.stock import stock_avatar_path

    return Humanoid.load(avatar or stock_avatar_path(), settings)
