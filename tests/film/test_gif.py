"""GIF films: what is small keeps its colour, and has the same one in every picture."""

import io
from pathlib import Path

import numpy as np
from PIL import Image

from elbowroom.film.gif import write_gif

SMALL = ((92, 50, 36), (20, 24, 52), (214, 84, 38))  # hair, trousers, shoes, each a thousandth of the picture
NEAR = 32  # of 255; with a palette for each picture it was 167


def picture(number: int) -> bytes:
    """A sky and a floor that change from picture to picture, and three small things that do not."""
    rng = np.random.default_rng(number)
    shades = np.linspace([236, 236, 232], [150 + 4 * number, 190, 186 - 3 * number], 180)[:, None, :]
    pixels = np.broadcast_to(shades, (180, 320, 3)) + rng.normal(0.0, 3.0, (180, 320, 3))
    for k, colour in enumerate(SMALL):
        pixels[100:107, 40 + 60 * k + number : 48 + 60 * k + number] = colour
    file = io.BytesIO()
    Image.fromarray(pixels.clip(0, 255).astype(np.uint8)).save(file, "PNG")
    return file.getvalue()


def test_what_is_small_has_its_own_colour_in_every_picture(tmp_path: Path) -> None:
    write_gif(tmp_path / "film.gif", 10.0, [picture(number) for number in range(8)])
    with Image.open(tmp_path / "film.gif") as film:
        assert film.n_frames == 8  # type: ignore[attr-defined]
        assert film.info["duration"] == 100
        found = []
        for number in range(8):
            film.seek(number)
            shown = np.asarray(film.convert("RGB"), np.int16)
            found.append([shown[103, 44 + 60 * k + number] for k in range(len(SMALL))])
    assert np.abs(np.array(found) - np.array(SMALL)).max() <= NEAR
    assert np.ptp(found, axis=0).max() == 0
