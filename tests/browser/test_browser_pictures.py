"""The tool that takes the documentation's pictures, on small ones."""

from typing import Any

import pytest

from live_server import LiveServer
from make_pictures import Scene, Still, View, moving, still

VIEW = View("scene=a&ui=0", (240, 135), (200, 10), -100)


@pytest.mark.long
def test_a_picture_that_stands(chromium: Any, live_server: LiveServer) -> None:
    picture = still(chromium, live_server.url, Still("small", VIEW, 0.3))
    assert picture.size == VIEW.size
    assert len(picture.getcolors(1 << 20) or []) > 500  # obstacles, ground and avatar, lit


@pytest.mark.long
def test_a_picture_that_moves(chromium: Any, live_server: LiveServer) -> None:
    pictures = moving(chromium, live_server.url, Scene(VIEW, 0.3, 0.45))
    assert len(pictures) >= 2
    assert all(picture.size == VIEW.size for picture in pictures)
    assert pictures[0].tobytes() != pictures[-1].tobytes()
