"""The scenes that come with the package, by name: light to import, so that a wrong name is told at once."""

from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path

from elbowroom.errors import InputError

_FILES = "a scene's file (.json) nor a model of a place (.glb, .gltf, .obj, .stl, .ply, .usd, .x3d, .wrl)"


class UnknownSceneError(InputError):
    """There is no scene of this name."""


def stock_folder() -> Traversable:
    """Where the scenes lie that come with the package."""
    return files("elbowroom.world") / "data" / "scenes"


def stock_names() -> tuple[str, ...]:
    """Their names: the paper's four first."""
    found = sorted(
        entry.name.removesuffix(".json") for entry in stock_folder().iterdir() if entry.name.endswith(".json")
    )
    return tuple(sorted(found, key=len))


def check_scene_name(name_or_path: str | Path) -> None:
    """Raises `UnknownSceneError` if this is neither a stock scene's name nor like a file's."""
    if isinstance(name_or_path, str) and name_or_path.lower() in stock_names():
        return
    path = Path(name_or_path)
    if not path.suffix and not path.is_file():
        names = ", ".join(stock_names())
        raise UnknownSceneError(f"scene {str(name_or_path)!r} is neither a stock scene ({names}) nor {_FILES}")
