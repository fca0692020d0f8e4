"""A walk as a page keeps it, saved: the file holds what the page showed."""

import asyncio
from contextlib import closing
from dataclasses import replace

import httpx
import numpy as np
import pytest
from numpy.typing import NDArray

from avatar_builder import Recipe, build
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading.avatar_file import load_humanoid_bytes
from elbowroom.errors import InputError
from elbowroom.export.animation import Animation, ShownPoses
from elbowroom.formats.bvh import parse_bvh
from elbowroom.formats.gltf import parse_gltf
from elbowroom.geometry import quaternion
from elbowroom.server.app import make_app
from elbowroom.server.stores import saving_desk
from elbowroom.server.stores.library import Library
from elbowroom.server.stores.saved_motion import save_motion
from elbowroom.server.wire.pose import Poser

Floats = NDArray[np.float64]

HERE = "http://127.0.0.1:8765"
RECIPES = {
    "stock": None,
    "turned nodes": Recipe(spin=True, between=True, mesh=False),
    "faces -Z, centimetres": Recipe(heading=np.pi, unit=100.0, root_scale=0.01, mesh=False),
}


def sent(humanoid: Humanoid, frames: int = 20) -> tuple[bytes, ShownPoses]:
    """Frames as a page sends them, and the poses in them."""
    rng = np.random.default_rng(0)
    t = np.arange(frames)[:, None] / 60.0
    phase = rng.uniform(0.0, 6.0, (len(humanoid.skeleton.names), 3))
    rotations = quaternion.from_rotation_vector(0.5 * np.sin(3.0 * t[:, None] + phase))
    hips = humanoid.skeleton.positions[0] + 0.1 * np.sin(t + np.arange(3.0))
    places, headings = np.concatenate([t, 0.0 * t, 2.0 * t], axis=1), 0.5 * t[:, 0]
    poser = Poser(humanoid)
    rows = []
    for i in range(frames):
        pose = poser.full_pose(rotations[i], hips[i])
        rows.append([t[i, 0], i >= frames, *places[i], headings[i], *pose.hips, *pose.rotations.ravel()])
    jumps = np.zeros(frames, bool)
    return np.array(rows, "<f4").tobytes(), ShownPoses(t[:, 0], jumps, rotations, hips, places, headings)


@pytest.mark.parametrize("name", RECIPES)
def test_what_the_page_showed_is_written(name: str) -> None:
    recipe = RECIPES[name]
    humanoid = Humanoid.default() if recipe is None else load_humanoid_bytes(build(recipe), "made.glb")
    data, poses = sent(humanoid)
    take = parse_bvh(save_motion(data, humanoid, "bvh").data, "walk.bvh").take()
    nodes = np.array([take.tree.names.index(bone) for bone in humanoid.skeleton.names])
    wanted = Animation.of_poses("walk", humanoid.skeleton, poses, 60.0).joints_in_world()
    np.testing.assert_allclose(take.world(nodes)[1] * 0.01, wanted, atol=1e-5)


@pytest.mark.parametrize("ending", ["glb", "vrma", "x3d", "usda", "npz", "csv"])
def test_every_format_can_be_saved(ending: str) -> None:
    humanoid = Humanoid.default()
    saved = save_motion(sent(humanoid)[0], humanoid, ending)
    assert len(saved.data) > 1000
    assert saved.notes == ()


async def post(
    library: Library, query: str, data: bytes, origin: str = HERE, path: str = "/api/motions"
) -> httpx.Response:
    transport = httpx.ASGITransport(make_app(library), client=("127.0.0.1", 50000))
    async with httpx.AsyncClient(transport=transport, base_url=HERE) as client:
        return await client.post(f"{path}?{query}", content=data, headers={"origin": origin})


def test_a_page_is_handed_the_file() -> None:
    data, _ = sent(Humanoid.default())
    with closing(Library.open("empty")) as library:
        answer = asyncio.run(post(library, "avatar=stock&format=vrma", data))
        assert answer.status_code == 200, answer.text
        assert answer.content[:4] == b"glTF"
        assert answer.headers["content-disposition"].endswith("-walk.vrma")
        assert parse_gltf(answer.content, "walk.vrma").root.at("animations").present
        assert len(list(library.avatars.folder.iterdir())) == 1  # of the stock avatar: nothing is left behind
        refused = asyncio.run(post(library, "avatar=nobody&format=vrma", data))
        assert refused.status_code == 422
        assert "nobody" in refused.json()["error"]
        assert (
            asyncio.run(post(library, "avatar=stock&format=bvh", data, "https://elsewhere.example")).status_code == 403
        )


def test_what_is_no_motion_is_refused() -> None:
    stock = Humanoid.default()
    data, _ = sent(stock)
    size = len(data) // 20
    backwards = data[size : 2 * size] + data[:size]
    broken = np.frombuffer(data, "<f4").copy()
    broken[7] = np.nan
    for wrong in (b"", data[:-4], data[: size // 2], backwards, broken.tobytes(), bytes(size) * 36_001):
        with pytest.raises(InputError, match="motion: "):
            save_motion(wrong, stock, "bvh")
    with pytest.raises(InputError, match="format: 'exe', there are bvh"):
        save_motion(data, stock, "exe")


def test_what_is_no_run_makes_no_page() -> None:
    with closing(Library.open("empty")) as library:
        answer = asyncio.run(post(library, "avatar=stock", b"no run at all", path="/api/pages"))
        assert answer.status_code == 422
        assert answer.json()["error"] == "run: what was sent is no run"
        assert len(list(library.avatars.folder.iterdir())) == 1


def test_files_are_written_apart_and_within_bounds(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(saving_desk, "_BOUNDS", replace(saving_desk._BOUNDS, memory=2**28))
    data, _ = sent(Humanoid.default(), 9000)
    with closing(Library.open("empty")) as library:
        answer = asyncio.run(post(library, "avatar=stock&format=csv", data))
        assert answer.status_code == 422
        assert answer.json()["error"].endswith("-walk.csv: takes more than 256 MiB of memory")
        assert len(list(library.avatars.folder.iterdir())) == 1
