"""How a clip is named: by a file, or by a file and the name that the clip has in it."""

from pathlib import Path


def split_reference(reference: str | Path) -> tuple[Path, str | None]:
    """`FILE#CLIP` as file and clip; a file whose own name has a # in it goes first."""
    text = str(reference)
    file, mark, name = text.rpartition("#")
    if not mark or not file or Path(text).is_file():
        return Path(text), None
    return Path(file), name
