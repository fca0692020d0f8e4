"""Places and scenes that pages send: how many stay, whose, and what becomes of those that go."""

import gc
import secrets
import weakref
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import replace
from pathlib import Path

import pytest

from elbowroom.errors import InputError
from elbowroom.server.entrance.page_key import Sender
from elbowroom.server.sessions.walk import WalkSettings
from elbowroom.server.sessions.wanted import Wanted
from elbowroom.server.stores import sent_scenes
from elbowroom.server.stores.library import Library
from elbowroom.server.stores.place_files import PlaceFiles
from elbowroom.server.stores.scene_weight import weight_of
from elbowroom.server.stores.sent_scenes import SentScenes
from elbowroom.world.scene import Scene
from place_builder import write_place

GONE = "not here any more"


@pytest.fixture(scope="module")
def rooms(tmp_path_factory: pytest.TempPathFactory) -> Scene:
    return Scene.load(write_place(tmp_path_factory.mktemp("place") / "rooms.glb"))


@pytest.fixture
def kept(tmp_path: Path) -> SentScenes:
    return SentScenes(PlaceFiles(tmp_path))


def sent(kept: SentScenes, scene: Scene, folder: Path, sender: str = "127.0.0.1", size: int = 10) -> tuple[str, Path]:
    """Send a place with a file of so many bytes: its name, and the file."""
    glb = folder / f"{secrets.token_hex(4)}.glb"
    glb.write_bytes(bytes(size))
    return kept.add_place(scene, glb, Sender(sender)).name, glb


def test_the_place_used_least_recently_goes_and_its_file_with_it(
    kept: SentScenes, rooms: Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sent_scenes, "MOST", 3)
    places = [sent(kept, rooms, tmp_path) for _ in range(3)]
    kept.get(places[0][0])
    places.append(sent(kept, rooms, tmp_path))
    assert [file.exists() for _, file in places] == [True, False, True, True]
    with pytest.raises(InputError, match=GONE):
        kept.get(places[1][0])


def test_what_a_session_shows_stays(
    kept: SentScenes, rooms: Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sent_scenes, "MOST", 2)
    shown, other = sent(kept, rooms, tmp_path), sent(kept, rooms, tmp_path)
    kept.hold("session", shown[0])
    third = sent(kept, rooms, tmp_path)
    assert [file.exists() for _, file in (shown, other, third)] == [True, False, True]
    kept.hold("another", third[0])
    with pytest.raises(InputError, match="in use"):
        sent(kept, rooms, tmp_path)
    assert len(list(tmp_path.iterdir())) == 2
    kept.hold("session")
    sent(kept, rooms, tmp_path)
    assert not shown[1].exists()


def test_a_stranger_fills_his_own_share(
    kept: SentScenes, rooms: Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sent_scenes, "MOST_EACH", 2)
    mine = sent(kept, rooms, tmp_path)
    theirs = [sent(kept, rooms, tmp_path, "192.0.2.7") for _ in range(4)]
    assert mine[1].exists()
    assert [file.exists() for _, file in theirs] == [False, False, True, True]


def test_the_bytes_of_all_are_bounded(
    kept: SentScenes, rooms: Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    weight = weight_of(rooms)
    monkeypatch.setattr(sent_scenes, "MOST_BYTES", 2 * (weight + 2000))
    files = [sent(kept, rooms, tmp_path, size=1000)[1] for _ in range(3)]
    assert [file.exists() for file in files] == [False, True, True]
    with pytest.raises(InputError, match="MiB here"):
        sent(kept, rooms, tmp_path, size=2 * (weight + 2000))
    assert [file.exists() for file in files] == [False, True, True]


def test_a_place_that_went_leaves_memory(kept: SentScenes, rooms: Scene, tmp_path: Path) -> None:
    sent_in = Scene.from_dict(rooms.to_dict(), "rooms")
    name, _ = sent(kept, sent_in, tmp_path)
    obstacles = weakref.ref(sent_in.obstacles)
    del sent_in
    assert obstacles() is not None
    for number in range(sent_scenes.MOST):
        kept.add_built(replace(rooms, title=f"{number}", place=None))
    gc.collect()
    assert obstacles() is None
    with pytest.raises(InputError, match=GONE):
        kept.get(name)


def test_a_scene_weighs_what_stands_in_it() -> None:
    boxes = [{"type": "box", "center": [2.0 + i % 40, 0.5, i // 40], "size": [0.3, 1.0, 0.3]} for i in range(1000)]
    weights = [weight_of(Scene.of("boxes", boxes[:many], finish=(0.0, 30.0))) for many in (0, 500, 1000)]
    assert weights[0] < 2**16
    assert 1.0e6 < weights[2] < 4.0e6
    assert weights[2] - weights[1] == pytest.approx(weights[1] - weights[0], rel=0.1)


def test_the_same_scene_has_the_same_name(kept: SentScenes, rooms: Scene) -> None:
    built = replace(rooms, place=None)
    first, again, other = (kept.add_built(scene) for scene in (built, built, replace(built, title="other")))
    assert first is again
    assert other.name != first.name
    assert kept.get("d") is None
    with pytest.raises(InputError, match="build mode"):
        kept.get("built:0123")


@contextmanager
def opened() -> Iterator[Library]:
    with closing(Library.open("empty")) as library:
        yield library


def test_sessions_hold_what_they_show(rooms: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sent_scenes, "MOST", 1)
    with opened() as library:
        name = library.sent.add_built(replace(rooms, place=None)).name
        library.hold("session", Wanted(name, "stock", WalkSettings()))
        with pytest.raises(InputError, match="in use"):
            library.sent.add_built(replace(rooms, title="other", place=None))
        library.hold("session")
        library.sent.add_built(replace(rooms, title="other", place=None))
