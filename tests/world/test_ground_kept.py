"""The ground of a place is made once and kept on disk: what is read is what was made, to the bit."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.world.ground import making
from elbowroom.world.ground.making import ground_of
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.shapes import Mesh
from elbowroom.world.places.floor_area import FloorArea

FLOOR = FloorArea((-3.0, -3.0), 0.5, np.ones((12, 12), np.bool_))


def hilly(side: int) -> Obstacles:
    """A mesh of 2 `side`² triangles over some metres, uneven by a decimetre."""
    rng = np.random.default_rng(side)
    x, z = np.meshgrid(np.linspace(-2.0, 2.0, side + 1), np.linspace(-2.0, 2.0, side + 1), indexing="ij")
    corners = np.stack([x, rng.uniform(0.02, 0.04, x.shape), z], axis=-1).reshape(-1, 3)
    first = (np.arange(side)[:, None] * (side + 1) + np.arange(side)).ravel()
    faces = np.concatenate(
        [np.stack([first, first + 1, first + side + 2], 1), np.stack([first, first + side + 2, first + side + 1], 1)]
    )
    return Obstacles(
        (Mesh(corners, faces),), np.zeros((1, 3)), np.array([[0.0, 0.0, 0.0, 1.0]]), ("hills",), ground=-9.0
    )


@pytest.fixture
def kept_in(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path / "elbowroom" / "places"


def made(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """How many triangles each ground had that was made from now on."""
    counted: list[int] = []
    make = making._gridded

    def counting(triangles: NDArray[np.float64], *others: Any) -> Any:
        counted.append(len(triangles))
        return make(triangles, *others)

    monkeypatch.setattr(making, "_gridded", counting)
    return counted


@pytest.mark.parametrize("floor", [None, FLOOR])
def test_what_is_read_is_what_was_made(kept_in: Path, monkeypatch: pytest.MonkeyPatch, floor: FloorArea | None) -> None:
    counted, hills = made(monkeypatch), hilly(34)
    new, again = ground_of(hills, floor), ground_of(hills, floor)
    assert counted == [2312]
    assert len(list(kept_in.glob("*.npz"))) == 1
    one: Any
    other: Any
    for one, other in zip(new, again, strict=True):
        assert type(one) is type(other)
        if isinstance(one, np.ndarray):
            assert one.dtype == other.dtype
            assert one.flags.c_contiguous == other.flags.c_contiguous
            assert np.array_equal(one, other)
        else:
            assert one == other


def test_other_ground_is_made_by_itself(kept_in: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    counted, hills = made(monkeypatch), hilly(34)
    steps = [ground_of(hills, FLOOR, step).step for step in (0.25, 0.4, 0.25)]
    assert steps == [0.25, 0.4, 0.25]
    ground_of(hills, FloorArea(FLOOR.origin, FLOOR.cell, np.pad(FLOOR.there[1:], ((1, 0), (0, 0)))))
    ground_of(hilly(35), FLOOR)
    assert counted == [2312, 2312, 2312, 2450]


def test_what_cannot_be_read_is_made_anew(kept_in: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    counted, hills = made(monkeypatch), hilly(34)
    new = ground_of(hills)
    (file,) = kept_in.glob("*.npz")
    file.write_bytes(file.read_bytes()[:5000])
    assert np.array_equal(ground_of(hills).triangles, new.triangles)
    assert len(counted) == 2


def test_small_grounds_are_not_kept(kept_in: Path) -> None:
    ground_of(hilly(4))
    assert not kept_in.exists()
