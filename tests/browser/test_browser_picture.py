"""What can be seen: the avatar behind its overlays."""

import io
from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from live_page import LivePage

Open = Callable[..., LivePage]


def trunk(live: LivePage) -> NDArray[np.float64]:
    """The colours of the middle of the trunk, (H, W, 3)."""
    state = live.state()
    (x, top), (_, bottom) = state["head"], state["feet"]
    tall = bottom - top
    box = {"x": x - 0.05 * tall, "y": top + 0.22 * tall, "width": 0.1 * tall, "height": 0.2 * tall}
    return np.asarray(Image.open(io.BytesIO(live.page.screenshot(clip=box))).convert("RGB"), np.float64)


@pytest.mark.parametrize("turn", [0, 600], ids=["from behind", "from ahead, through the ghosts"])
def test_with_all_overlays_on_the_avatar_stays_in_sight(open_page: Open, turn: int) -> None:
    live = open_page("scene=empty&overlays=all", viewport=(1000, 700))
    live.wait("s.scene === 'empty'")
    live.page.keyboard.down("w")
    live.wait("s.root.z > 0.6 && s.capsulesReceived > 0")
    live.page.keyboard.press("p")
    live.page.keyboard.up("w")
    live.wait("s.paused")
    live.page.mouse.move(200, 500)
    live.page.mouse.down()
    live.page.mouse.move(200 + turn, 500, steps=4)
    live.page.mouse.up()
    live.page.wait_for_timeout(1500)
    covered = trunk(live)
    live.page.keyboard.press("o")
    live.wait("s.overlays.length === 0")
    live.page.wait_for_timeout(500)
    bare = trunk(live)
    assert np.abs(covered - bare).mean() < 30.0
