"""Arrays that are kept on disk: found again by content, made anew where damaged, no more than there is room for."""

import os
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.kept_arrays import Arrays, bound, folder, kept
from elbowroom.planning.navigation.girth import girth_of
from elbowroom.planning.navigation.room_map import ground_of, room_map
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.shapes import Box, Mesh
from elbowroom.world.places.options import PlaceOptions
from elbowroom.world.scene import Scene


@pytest.fixture(autouse=True)
def _own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))


def files() -> list[Path]:
    where = folder()
    assert where is not None
    return sorted(where.glob("*"))


def test_what_was_made_of_the_same_is_found_and_nothing_else() -> None:
    made: list[float] = []

    def double(values: np.ndarray) -> Arrays:
        made.append(float(values.sum()))
        return {"twice": 2.0 * values, "words": np.array(["a", "bc"])}

    rng = np.random.default_rng(0)
    drawn = [rng.random((rng.integers(0, 4), 3)) for _ in range(6)]
    for values in (*drawn, *drawn):
        found = kept(__file__, (b"double", values), partial(double, values))
        np.testing.assert_array_equal(found["twice"], 2.0 * values)
        assert found["words"].tolist() == ["a", "bc"]
    distinct = {values.tobytes() for values in drawn}
    assert len(made) == len(distinct) == len(files())
    kept(__file__, (b"doubl", b"e", drawn[0]), lambda: double(drawn[0]))
    assert len(made) == len(distinct) + 1, "where one part ends counts"


@pytest.mark.parametrize("where", [0, 0.3, 0.6, 0.95, "cut", "empty"])
def test_what_is_damaged_is_made_anew(where: float | str) -> None:
    values = np.random.default_rng(1).random(500)
    for _ in range(2):
        found = kept(__file__, (values,), lambda: {"values": values})
        np.testing.assert_array_equal(found["values"], values)
        (file,) = files()
        data = bytearray(file.read_bytes())
        if isinstance(where, str):
            data = data[: len(data) // 2 if where == "cut" else 0]
        else:
            data[int(where * len(data))] ^= 0xFF
        file.write_bytes(data)
    np.testing.assert_array_equal(kept(__file__, (values,), lambda: {"values": values})["values"], values)


def test_what_was_not_used_for_longest_goes() -> None:
    for number in range(5):
        kept(__file__, (bytes([number]),), partial(dict, it=np.full(1000, number)))
        os.utime(max(files(), key=lambda file: file.stat().st_mtime), (number + 1e9, number + 1e9))
    size = files()[0].stat().st_size
    where = folder()
    assert where is not None
    bound(where, int(2.5 * size))
    left = {int(kept_file.stat().st_mtime - 1e9) for kept_file in files()}
    assert left == {3, 4}


def bumps(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """A floor of many triangles, and things on it."""
    rng, (i, j) = np.random.default_rng(seed), np.mgrid[0:60, 0:60]
    points = np.stack([0.1 * i, np.where(rng.random(i.shape) < 0.02, 0.8, 0.0), 0.1 * j], axis=-1).reshape(-1, 3)
    corner = (60 * i + j)[:-1, :-1].reshape(-1, 1)
    return points, np.concatenate([corner + np.array([0, 1, 60]), corner + np.array([1, 61, 60])])


def test_a_place_is_the_same_from_disk(tmp_path: Path) -> None:
    points, faces = bumps(3)
    lines = [f"v {x} {y} {z}" for x, y, z in points.tolist()] + [f"f {a} {b} {c}" for a, b, c in (faces + 1).tolist()]
    (tmp_path / "floor.obj").write_text("\n".join(lines))
    avatar, seen = Humanoid.default(), []
    for _ in range(2):
        scene = Scene.load(tmp_path / "floor.obj", PlaceOptions(scale=1.0, up="y"))
        room = room_map(scene, girth_of(avatar), ground_of(scene))
        seen.append((scene, scene.obstacles.standing, scene.obstacles.names, room))
    (first, rows, names, room), (again, rows_again, names_again, room_again) = seen
    assert files(), "it is large enough to be kept"
    assert (first.start, first.finish, first.description) == (again.start, again.finish, again.description)
    assert names == names_again
    for one, other in ((rows.rows, rows_again.rows), (rows.packed, rows_again.packed), (room.room, room_again.room)):
        np.testing.assert_array_equal(one, other)
    assert first.place is not None
    assert again.place is not None
    assert first.place.options == again.place.options
    if first.place.floor is not None:
        assert again.place.floor is not None
        np.testing.assert_array_equal(first.place.floor.there, again.place.floor.there)


def test_parts_from_disk_are_those_of_the_same_obstacles() -> None:
    points, faces = bumps(5)
    shapes, turns = (Box((1.0, 2.0, 1.0)), Mesh(points, faces)), np.tile([0.0, 0.0, 0.0, 1.0], (2, 1))
    made = [Obstacles(shapes, np.array([[9.0, 1.0, 9.0], [0.0, 0.0, 0.0]]), turns, ("box", "floor")) for _ in range(2)]
    np.testing.assert_array_equal(made[0].standing.rows, made[1].standing.rows)
    np.testing.assert_array_equal(made[0].standing.packed, made[1].standing.packed)
    assert made[0].names == made[1].names
    moved = Obstacles(shapes, np.array([[9.0, 1.0, 9.0], [0.0, 0.1, 0.0]]), turns, ("box", "floor"))
    assert not np.array_equal(made[0].standing.rows, moved.standing.rows)
