"""Avatars with compressed meshes look on the page as they do without."""

import io
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from compressed_vrm import with_draco, with_meshopt
from elbowroom.body.stock import stock_avatar_path
from live_page import READ, LivePage

Picture = NDArray[np.int16]
Open = Callable[..., LivePage]

_VISIBLE = 24  # of 255
_EDGES = 100  # pixels that may look different
_ALONE = ".chrome, .notice { visibility: hidden !important }"


def picture(live: LivePage) -> Picture:
    """What is drawn when all has come to rest, (H, W, 3)."""
    live.settle()
    return np.asarray(Image.open(io.BytesIO(live.page.screenshot())).convert("RGB"), np.int16)


def shown(live: LivePage, file: Path) -> Picture:
    """The picture of an avatar that was dropped on the page."""
    before = live.state()["avatarRevision"]
    live.page.set_input_files("#file", str(file))
    live.wait(f"s.avatarRevision > {before} && s.avatarRevision === s.poseRevision", READ)
    return picture(live)


def differing(a: Picture, b: Picture) -> int:
    """How many pixels look different."""
    return int(np.count_nonzero(np.abs(a - b).max(axis=2) > _VISIBLE))


@pytest.mark.long
def test_compressed_avatars_look_as_plain_ones(open_page: Open, tmp_path: Path) -> None:
    """A figure that is not drawn differs by 10,000 pixels."""
    plain = stock_avatar_path().read_bytes()
    files = {"plain": plain, "draco": with_draco(plain), "meshopt": with_meshopt(plain)}
    live, pictures = open_page("scene=empty", reduced_motion="reduce"), {}
    live.page.add_style_tag(content=_ALONE)
    for name, data in files.items():
        path = tmp_path / f"{name}.vrm"
        path.write_bytes(data)
        pictures[name] = shown(live, path)
    assert differing(pictures["draco"], pictures["plain"]) < _EDGES
    assert differing(pictures["meshopt"], pictures["plain"]) < _EDGES
