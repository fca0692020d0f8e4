"""Sheets: sixteen pictures, drawn no larger than they are shown."""

import io
from pathlib import Path

from PIL import Image

from elbowroom.film.files import write_film
from elbowroom.film.page import FilmedPage
from elbowroom.film.settings import Look, drawn_scale


class PlainPage(FilmedPage):
    """A page whose pictures are of one grey each, lighter as time goes on."""

    def __init__(self, size: tuple[int, int], scale: float) -> None:
        super().__init__(None, Look(size))
        self.drawn = (round(size[0] * scale), round(size[1] * scale))

    @property
    def duration(self) -> float:
        """Seconds: as many as a sheet has pictures, less one."""
        return 15.0

    def picture(self, seconds: float) -> bytes:
        """The picture of a moment."""
        file = io.BytesIO()
        Image.new("L", self.drawn, 10 * round(seconds)).save(file, "png")
        return file.getvalue()


def test_a_sheet_shows_its_pictures_as_large_as_they_are_drawn_in_their_order(tmp_path: Path) -> None:
    path = tmp_path / "sheet.png"
    page = PlainPage((128, 96), drawn_scale(path))
    assert write_film(page, path, 30.0, 1.0, lambda done, all_: None) == 16
    sheet = Image.open(path).convert("L")
    assert sheet.size == (128, 96)
    assert page.drawn == (32, 24)
    assert [sheet.getpixel((32 * (k % 4) + 9, 24 * (k // 4) + 9)) for k in range(16)] == [10 * k for k in range(16)]


def test_other_films_are_drawn_at_their_size() -> None:
    assert {drawn_scale(Path(f"walk{kind}")) for kind in (".webm", ".mp4", ".gif")} == {1.0}
