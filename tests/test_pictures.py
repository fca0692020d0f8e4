"""The pictures of README and docs are there, are used, and can be made again by one command."""

import re
from pathlib import Path

from PIL import Image

from make_pictures import MOST_BYTES, MOVING_NAME, STILLS

ROOT = Path(__file__).parents[1]
IMAGES = ROOT / "docs" / "images"
README = (ROOT / "README.md").read_text("utf-8")
SHOWN = re.compile(r"!\[([^\]]*)\]\(([^)]+)\)")


def pictures_of(page: Path) -> list[tuple[str, Path]]:
    """What is said of each picture of a page, and its file."""
    return [(words, (page.parent / file).resolve()) for words, file in SHOWN.findall(page.read_text("utf-8"))]


def all_pictures() -> list[tuple[str, Path]]:
    return [shown for page in (ROOT / "README.md", *(ROOT / "docs").glob("*.md")) for shown in pictures_of(page)]


def test_every_picture_is_there_is_used_and_is_described() -> None:
    assert {file for _, file in all_pictures()} == {file.resolve() for file in IMAGES.iterdir()}
    assert all(len(words.split()) >= 4 for words, _ in all_pictures())


def test_the_first_picture_of_the_readme_moves() -> None:
    first = pictures_of(ROOT / "README.md")[0][1]
    assert first.name == MOVING_NAME
    assert first.stat().st_size < MOST_BYTES
    with Image.open(first) as picture:
        assert picture.n_frames > 30  # type: ignore[attr-defined]


def test_one_command_makes_them_all() -> None:
    tools = "".join(path.read_text("utf-8") for path in (ROOT / "tools").glob("make_*.py"))
    plots = (ROOT / "src" / "elbowroom" / "cli" / "bench" / "plan.py").read_text("utf-8")
    recipe = (ROOT / "Makefile").read_text("utf-8").split("\npictures:")[1].split("\n\n")[0]
    for tool in (ROOT / "tools").glob("make_*pictures.py"):
        assert tool.name in recipe
    made = {f"{still.name}.png" for still in STILLS} | {MOVING_NAME}
    for file in IMAGES.iterdir():
        name = re.sub(r"^(planning_by_).*", r"\1", file.name)
        assert name in made or any(name in text for text in (tools, recipe, plots)), file.name
