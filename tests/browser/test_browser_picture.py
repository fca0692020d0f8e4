"""What can be seen: the avatar behind its overlays."""

import io
from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from live_page import LivePage

Open = Callable[..., LivePage]


# Where the body is, as shares of its height from the top, and how much overlays may change its colours there (of 255).
# When they were drawn evenly over it, they changed the trunk by 21 to 41 and the hips by 35 to 76, with a capsule
# less on each thigh than now.
PARTS = {"trunk": (0.22, 0.42, 14.0), "hips": (0.48, 0.6, 40.0)}


def body(live: LivePage) -> dict[str, NDArray[np.float64]]:
    """The colours of parts of the body, each (H, W, 3)."""
    state = live.state()
    (x, top), (_, bottom) = state["head"], state["feet"]
    tall = bottom - top
    seen = {}
    for part, (begin, end, _) in PARTS.items():
        box = {"x": x - 0.06 * tall, "y": top + begin * tall, "width": 0.12 * tall, "height": (end - begin) * tall}
        picture = Image.open(io.BytesIO(live.page.screenshot(clip=box)))
        seen[part] = np.asarray(picture.convert("RGB"), np.float64)
    return seen


@pytest.mark.long
@pytest.mark.parametrize("camera", ["behind", pytest.param("front", marks=pytest.mark.long)])
def test_with_all_overlays_on_the_avatar_stays_in_sight(open_page: Open, camera: str) -> None:
    live = open_page(f"scene=empty&overlays=all&camera={camera}", viewport=(1000, 700))
    live.wait("s.scene === 'empty'")
    live.page.keyboard.down("w")
    live.wait("s.root.z > 0.6 && s.capsulesReceived > 0")
    live.page.keyboard.press("p")
    live.page.keyboard.up("w")
    live.wait("s.paused")
    live.settle()
    covered = body(live)
    live.page.keyboard.press("o")
    live.wait("s.overlays.length === 0")
    live.settle()
    bare = body(live)
    for part, (_, _, most) in PARTS.items():
        assert np.abs(covered[part] - bare[part]).mean() < most, part


def contrasts_ahead(live: LivePage) -> NDArray[np.float64]:
    """How much colours differ (of 255) along rows of the picture, left of who walks, from knees' height downwards."""
    state = live.state()
    (x, top), (_, bottom) = state["head"], state["feet"]
    above = 0.3 * (bottom - top)
    box = {"x": 0.0, "y": bottom - above, "width": 0.7 * x, "height": 600.0 - bottom + above}
    picture = Image.open(io.BytesIO(live.page.screenshot(clip=box)))
    rows = np.asarray(picture.convert("RGB"), np.float64)
    contrasts: NDArray[np.float64] = np.ptp(rows, axis=1).mean(axis=1)
    return contrasts


@pytest.mark.long
def test_past_the_finish_the_avatar_walks_on_and_so_does_the_ground(open_page: Open) -> None:
    """Its squares and lines are there where the scene's own floor, which ends at 8 m, has long ended."""
    live = open_page("scene=doorway&speed=1.6&ui=0&camera=behind", viewport=(800, 600))
    live.wait("s.scene === 'doorway'")
    live.page.keyboard.down("w")
    live.wait("s.finished")
    beyond = live.wait("s.root.z > 14")
    assert (beyond["finished"], beyond["crossed"], beyond["stuckNow"], beyond["heldKeys"]) == (True, 1, False, 1)
    live.page.keyboard.press("p")
    live.page.keyboard.up("w")
    live.wait("s.paused")
    live.settle()
    contrasts = contrasts_ahead(live)
    assert len(contrasts) > 100
    assert float(np.median(contrasts)) > 5.0  # it is 17; of one colour all over it would be 0
