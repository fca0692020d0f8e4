"""Walks with others about: who they are is drawn, each makes way, and the judge looks at all of them."""

from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("pyarrow", reason="needs pyarrow: pip install 'elbowroom[dataset]'")
pytest.importorskip("coal", reason="needs coal: pip install 'elbowroom[judge]'")

import pyarrow.parquet as pq

from elbowroom.body.dof import DOF
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import ROOT_STATE
from elbowroom.dataset.check import check_dataset
from elbowroom.dataset.company import NoRoomError
from elbowroom.dataset.draw import draw
from elbowroom.dataset.make import make_dataset
from elbowroom.dataset.spec import DatasetSpec
from elbowroom.dataset.walk import company_on, controller_of, setting_of
from elbowroom.errors import InputError
from elbowroom.experiment.judge.apart import ShownWalker, judge_apart
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.parallel import ThisProcess
from place_builder import Boxes, write_place

SPEC = DatasetSpec(walks=1, shard=1, seconds=1.2, places=("gauntlet:1",), company=(2,))
CLOSET: Boxes = {
    "Floor": ((0, -0.1, 0), (2.6, 0.2, 2.6)),
    "Wall_west": ((-1.35, 1.2, 0), (0.1, 2.4, 2.8)),
    "Wall_east": ((1.35, 1.2, 0), (0.1, 2.4, 2.8)),
    "Wall_south": ((0, 1.2, -1.35), (2.8, 2.4, 0.1)),
    "Wall_north": ((0, 1.2, 1.35), (2.8, 2.4, 0.1)),
}


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("company")
    make_dataset(SPEC, folder, ThisProcess())
    return folder


def standing(x: float, z: float, frames: int = 3) -> ShownWalker:
    roots = np.zeros((frames, ROOT_STATE))
    roots[:, 0], roots[:, 1] = x, z
    q = np.zeros((frames, DOF))
    q[:, :2] = x, z
    return ShownWalker(Humanoid.default(), ShownMotion.at_rate(q, roots))


def test_others_are_drawn_and_all_else_is_as_without() -> None:
    alone = DatasetSpec(walks=20, places=SPEC.places)
    for number in range(20):
        with_others = draw(SPEC, number)
        assert len(with_others.others) == 2
        assert with_others._replace(others=()) == draw(alone, number)


def test_the_rows_tell_where_they_were(made: Path) -> None:
    table = pq.read_table(sorted(made.glob("*.parquet")))
    assert len(table)
    for row in table.to_pylist():
        assert row["others"] == ["stock", "stock"]
        own = np.array(row["root"])
        for root, joints in zip(row["others_root"], row["others_joints"], strict=True):
            states, places = np.reshape(root, (row["frames"], 8)), np.reshape(joints, (row["frames"], 22, 3))
            assert np.hypot(*(states[0, :2] - own[0, :2])) >= 1.2 - 1e-3
            assert np.linalg.norm(places[:, 0, [0, 2]] - states[:, :2], axis=1).max() < 0.3  # hips are over the root
            way, turned = np.abs(np.diff(states[:, :3], axis=0)).sum(axis=0)[:2], np.ptp(states[:, 2])
            assert np.hypot(*way) > 0.2 or turned > 1.0  # and go somewhere, or turn first to where they will go


@pytest.mark.long
def test_walked_again_they_are_the_same(made: Path) -> None:
    checked = check_dataset(made, ThisProcess(), 1)
    assert checked.faults == ()
    assert checked.walked == 1


def test_the_judge_finds_bodies_that_are_in_each_other() -> None:
    found = judge_apart(standing(0.0, 0.0), standing(0.1, 0.0))
    assert found.touching == 9  # three frames, and three poses between each two of them
    assert found.deepest > 0.05
    assert judge_apart(standing(0.0, 0.0), standing(1.5, 0.0)) == (0, 0.0)


def test_where_there_is_no_room_for_them_it_is_said(tmp_path: Path) -> None:
    closet = write_place(tmp_path / "closet.glb", CLOSET)
    spec = DatasetSpec(places=(str(closet),), company=(8,))
    drawn = draw(spec, 0)
    setting = setting_of(drawn)
    with pytest.raises(NoRoomError, match="no room for"):
        company_on(drawn, setting, controller_of(spec, drawn, setting))


@pytest.mark.parametrize("company", [[], [9], [-1], ["1"], [True], 1])
def test_a_wrong_company_is_told(company: object) -> None:
    with pytest.raises(InputError, match="company"):
        DatasetSpec.of({"company": company})
