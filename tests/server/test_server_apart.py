"""Work apart: what a process answers, what it may take, and that it ends when nobody waits for it."""

import asyncio
import os
import pickle
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from child_processes import children
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.stock import stock_avatar_path
from elbowroom.clips.clip import Clip
from elbowroom.errors import InputError
from elbowroom.experiment.gauntlet.scenes import course_scene
from elbowroom.server.apart.answers import packed, unpacked
from elbowroom.server.apart.bounds import Bounds
from elbowroom.server.apart.process import FullDiskError, run_apart
from elbowroom.server.stores.courses import BusyError, Courses
from elbowroom.world.scene import Scene


def read(file: Path, name: str, glb: Path, bounds: Bounds | None = None) -> tuple[Humanoid, list[str], str]:
    made: tuple[Humanoid, list[str], str] = asyncio.run(
        run_apart("read_upload", name, str(file), name, str(glb), bounds=bounds or Bounds())
    )
    return made


def test_an_avatar_read_apart_is_the_avatar(tmp_path: Path) -> None:
    humanoid, clips, _ = read(stock_avatar_path(), "mine.vrm", tmp_path / "out.glb")
    here = Humanoid.default()
    assert clips == []
    assert humanoid.glb is None
    assert (tmp_path / "out.glb").read_bytes() == here.glb
    np.testing.assert_array_equal(humanoid.skeleton.positions, here.skeleton.positions)
    np.testing.assert_array_equal(humanoid.capsules.radii, here.capsules.radii)
    assert humanoid.meta.bones == here.meta.bones


def test_what_is_wrong_is_told_in_the_readers_words(tmp_path: Path) -> None:
    file = tmp_path / "x"
    file.write_bytes(b"no avatar")
    with pytest.raises(InputError, match=r"^broken\.vrm"):
        read(file, "broken.vrm", tmp_path / "out.glb")


def test_too_much_memory_is_one_line(tmp_path: Path) -> None:
    """The kind of file that froze every session: few bytes that become many objects."""
    file = tmp_path / "x"
    file.write_bytes(b'{"asset":{"version":"2.0"},"a":[' + b"{}," * 4_000_000 + b"{}]}")
    began = time.monotonic()
    with pytest.raises(InputError, match=r"^objects\.gltf: takes more than 300 MiB of memory"):
        read(file, "objects.gltf", tmp_path / "out.glb", Bounds(memory=300 * 2**20))
    assert time.monotonic() - began < 60.0


@pytest.mark.parametrize(
    ("bounds", "told"),
    [
        (Bounds(wall=0.05), "takes more than 0.05 s"),
        (Bounds(answer=1000), "unpacks to more than"),
    ],
)
def test_too_long_and_too_large(bounds: Bounds, told: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=told):
        read(stock_avatar_path(), "mine.vrm", tmp_path / "out.glb", bounds)


def test_a_full_disk_is_told(tmp_path: Path) -> None:
    with pytest.raises(FullDiskError):
        read(stock_avatar_path(), "mine.vrm", tmp_path / "out.glb", Bounds(written=10_000))


def test_too_much_processor_time(monkeypatch: pytest.MonkeyPatch) -> None:
    busy = asyncio.run(_ended_by("while True: pass", Bounds(processor=1), monkeypatch))
    assert "more than 1 s of a processor" in busy


def test_a_reader_that_crashes_is_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    assert "SIGSEGV" in asyncio.run(_ended_by("os.kill(os.getpid(), 11)", Bounds(), monkeypatch))


@pytest.mark.skipif(sys.platform == "win32", reason="no process groups")
def test_a_reader_stands_behind_the_server(monkeypatch: pytest.MonkeyPatch) -> None:
    """Linux shares time among sessions first: one of its own would have as much of it as the server, however nice."""
    seen = f"(os.getsid(0) == {os.getsid(0)}) + 2 * (os.getpgid(0) != {os.getpgid(0)}) + 4 * (os.nice(0) >= 5)"
    assert "exit code 7" in asyncio.run(_ended_by(f"os._exit({seen})", Bounds(), monkeypatch))


async def _ended_by(code: str, bounds: Bounds, monkeypatch: pytest.MonkeyPatch) -> str:
    """What is told of a reader that runs this code."""
    started = asyncio.create_subprocess_exec
    body = (
        "import os, sys; from elbowroom.server.apart.bounds import Bounds, keep_to;"
        f"keep_to(Bounds.from_text(sys.argv[1]))\n{code}"
    )

    async def other(*command: str, **options: object) -> asyncio.subprocess.Process:
        return await started(command[0], "-c", body, *command[3:], **options)  # type: ignore[arg-type]

    monkeypatch.setattr(asyncio, "create_subprocess_exec", other)
    with pytest.raises(InputError) as caught:
        await run_apart("read_upload", "bad.vrm", bounds=bounds)
    return str(caught.value)


def test_nobody_waits_so_it_ends(tmp_path: Path) -> None:
    async def leave() -> None:
        task = asyncio.create_task(run_apart("make_course", "a course", "gauntlet:10:5"))
        while not children() - before:
            await asyncio.sleep(0.01)
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task
        deadline = time.monotonic() + 5.0
        while children() - before and time.monotonic() < deadline:
            await asyncio.sleep(0.02)
        assert not children() - before

    before = children()
    asyncio.run(leave())


def test_an_answer_may_hold_records_and_arrays_alone() -> None:
    clip = unpacked(packed(Humanoid.default().meta))
    assert clip == Humanoid.default().meta

    class Call:
        def __reduce__(self) -> tuple[object, tuple[str]]:
            return os.system, ("echo called",)

    for data in (pickle.dumps(Call()), pickle.dumps(Path("x")), pickle.dumps(Clip.load), b"", b"\x80\x05N", b"junk"):
        with pytest.raises(pickle.UnpicklingError):
            unpacked(data)


# --- courses -----------------------------------------------------------------------------------------------------


def test_a_course_made_apart_is_the_course() -> None:
    made = asyncio.run(Courses().find("gauntlet:2:7", "me"))
    here = course_scene("gauntlet:2:7")
    assert made.name == here.name
    assert made.start == here.start
    assert made.to_dict() == here.to_dict()


def test_one_course_at_a_time_for_each_client_and_a_few_remembered(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[str] = []

    async def slow(job: str, name: str, course: str) -> object:
        made.append(course)
        await asyncio.sleep(0.05)
        return Scene.load("a").to_dict()

    async def ask() -> None:
        first = asyncio.create_task(courses.find("gauntlet:1:1", "me"))
        await asyncio.sleep(0.01)
        with pytest.raises(BusyError):
            await courses.find("gauntlet:1:2", "me")
        other = asyncio.create_task(courses.find("gauntlet:1:1", "you"))  # waits, and finds it made
        assert (await first).name == (await other).name == "gauntlet:1:1"
        assert made == ["gauntlet:1:1"]
        for number in range(2, 40):
            await courses.find(f"gauntlet:1:{number}", "me")
        assert courses.known("gauntlet:1:1") is None
        assert courses.known("gauntlet:1:39") is not None

    monkeypatch.setattr("elbowroom.server.stores.courses.run_apart", slow)
    courses = Courses()
    asyncio.run(ask())
