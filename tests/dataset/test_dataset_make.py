"""Datasets of walks: what is drawn, files that come out the same whatever happened meanwhile, what strangers read."""

import json
import subprocess
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

pytest.importorskip("pyarrow", reason="needs pyarrow: pip install 'elbowroom[dataset]'")
pytest.importorskip("coal", reason="needs coal: pip install 'elbowroom[judge]'")

import duckdb
import pyarrow.parquet as pq

from bvh_builder import BvhRecipe, write_bvh
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, posture_capsules
from elbowroom.body.root import ROOT_STATE, as_told
from elbowroom.cli.main import app
from elbowroom.dataset.check import check_dataset
from elbowroom.dataset.columns import COLUMNS, SCHEMA, SMPL_BONES
from elbowroom.dataset.draw import draw
from elbowroom.dataset.figures import Figures
from elbowroom.dataset.hands import HANDS
from elbowroom.dataset.in_use import in_use
from elbowroom.dataset.make import make_dataset
from elbowroom.dataset.manifest import Manifest
from elbowroom.dataset.report import write_report
from elbowroom.dataset.spec import STEERING, DatasetSpec
from elbowroom.dataset.walk import WalkTask
from elbowroom.errors import InputError
from elbowroom.experiment.parallel import Processes
from elbowroom.world.scene import Scene
from made_walk import FPS, made_walk
from place_builder import Boxes, write_place

SPEC = DatasetSpec(
    walks=4, shard=2, seconds=1.2, places=("gauntlet:2", "doorway", "traffic"), steering=("straight", "key flips")
)
STOCK_SPEC = Path(__file__).parents[2] / "examples" / "dataset.json"


class Here(Processes):
    """Does tasks in this process, in some order; after so many it is interrupted."""

    def __init__(self, most: int = 1000, backwards: bool = False) -> None:
        super().__init__()
        object.__setattr__(self, "most", most)
        object.__setattr__(self, "backwards", backwards)

    def run(self, tasks: Sequence[Any]) -> Iterator[tuple[int, Any]]:
        order = list(enumerate(tasks))[:: -1 if self.backwards else 1]  # type: ignore[attr-defined]
        for done, (place, task) in enumerate(order):
            if done == self.most:  # type: ignore[attr-defined]
                raise KeyboardInterrupt
            yield place, task.run()


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("made")
    make_dataset(SPEC, folder, Here())
    return folder


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def table(folder: Path) -> Any:
    return pq.read_table(sorted(folder.glob("*.parquet")))


def test_interrupted_and_backwards_it_is_the_same_to_the_byte(made: Path, tmp_path: Path) -> None:
    broken = tmp_path / "broken"
    with pytest.raises(KeyboardInterrupt):
        make_dataset(SPEC, broken, Here(3, backwards=True))
    assert len(list(broken.glob("*.parquet"))) == 1
    make_dataset(SPEC, broken, Here())
    assert contents(broken) == contents(made)


@pytest.mark.long
def test_grown_it_is_the_same_to_the_byte(made: Path, tmp_path: Path) -> None:
    grown = tmp_path / "grown"
    make_dataset(replace(SPEC, walks=3), grown, Here())
    make_dataset(SPEC, grown, Here())
    assert contents(grown) == contents(made)


def test_another_spec_needs_another_folder(made: Path) -> None:
    with pytest.raises(InputError, match="another seed, fps"):
        make_dataset(replace(SPEC, fps=20, seed=5), made, Here())


def test_rows_are_what_was_walked(made: Path) -> None:
    """Clearances and feet by the body itself, places by the judge's own way of posing."""
    from elbowroom.experiment.motion.walked import posed

    rows, humanoid = table(made).to_pylist(), Humanoid.default()
    assert [row["walk"] for row in rows] == sorted({row["walk"] for row in rows})
    manifest = Manifest.load(made)
    assert manifest is not None
    assert len(rows) == sum(one.walks for one in manifest.shards)
    assert len(rows) >= 3
    for row in rows:
        q, root = np.array(row["q"]), np.array(row["root"])
        behind = np.zeros((len(root), ROOT_STATE - root.shape[1])), row["feet"], row["carriage"]
        roots = as_told(np.hstack([root, *behind]))
        frames = row["frames"]
        assert len(q) == len(roots) == len(row["time"]) == len(row["near"]) == len(row["height"]) == frames
        assert np.diff(row["time"]) == pytest.approx(1.0 / row["fps"], abs=1e-5)
        skeleton = humanoid.skeleton
        there = [SMPL_BONES.index(bone) for bone in SMPL_BONES if skeleton.has(bone)]
        joints = posed(humanoid, q, roots).positions[:, [skeleton.index(SMPL_BONES[k]) for k in there]]
        assert np.array(row["joints"]).reshape(frames, -1, 3)[:, there] == pytest.approx(joints, abs=1e-4)
        turns = np.array(row["rotations"]).reshape(frames, -1, 4)
        assert np.linalg.norm(turns, axis=2) == pytest.approx(1.0, abs=1e-5)
        scene = Scene.from_dict(json.loads(row["scene"]))
        segments = posture_capsules(body_model(humanoid), q, roots)
        for n in range(0, frames, 20):
            own = segments[:, :, n : n + 1] - np.tile([roots[n, 0], 0.0, roots[n, 1]], 2)[:, None].astype(np.float32)
            clear = scene.obstacles.clearance(own, humanoid.capsules.radii, roots[n, :2], row["time"][n])
            assert row["clearance"][n] == pytest.approx(clear, abs=2e-3)
            assert row["nearest"][n] in row["near"][n] or row["clearance"][n] > 2.0


def test_walks_that_touch_are_left_out_and_listed(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    walk = WalkTask.run
    monkeypatch.setattr(WalkTask, "run", lambda task: "touches in 3 poses" if task.number == 1 else walk(task))
    manifest = make_dataset(replace(SPEC, walks=2), tmp_path, Here())
    assert manifest.shards[0].rejected == {"1": "touches in 3 poses"}
    assert [manifest.why_left_out(walk) for walk in (0, 1)] == [None, "touches in 3 poses"]
    assert table(tmp_path).column("walk").to_pylist() == [0]
    assert "- 1: touches something" in (tmp_path / "README.md").read_text()


def test_strangers_read_the_same(made: Path) -> None:
    files = str(made / "*.parquet")
    ((count, frames, first),) = (
        duckdb.connect()
        .execute(f"select count(*), sum(len(q)), first(q[1][4] order by walk) from '{files}'")
        .fetchall()
    )
    assert (count, frames) == (table(made).num_rows, sum(table(made).column("frames").to_pylist()))
    assert first == table(made).column("q")[0].as_py()[0][3]
    assert pq.read_schema(next(made.glob("*.parquet"))).equals(SCHEMA)


@pytest.mark.long
def test_hugging_face_reads_the_same(made: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its library, in a process of its own: it keeps what it read in a cache, and asks nobody outside."""
    monkeypatch.setenv("HF_HOME", str(tmp_path))
    monkeypatch.setenv("HF_HUB_OFFLINE", "1")
    monkeypatch.setenv("HF_DATASETS_OFFLINE", "1")
    program = (
        "import sys, json, datasets\n"
        "datasets.disable_progress_bars()\n"
        "walks = datasets.load_dataset(sys.argv[1], split='train')\n"
        "print(json.dumps([walks['walk'][:], walks[0]['q'][1], sorted(walks.column_names)]))\n"
    )
    outcome = subprocess.run([sys.executable, "-c", program, str(made)], capture_output=True, text=True, check=True)
    numbers, posture, names = json.loads(outcome.stdout.splitlines()[-1])
    assert numbers == table(made).column("walk").to_pylist()
    assert posture == table(made).column("q")[0].as_py()[1]
    assert names == sorted(column.name for column in COLUMNS)


def test_pytorch_trains_on_it(made: Path) -> None:
    pytest.importorskip("torch", reason="needs PyTorch")
    example = Path(__file__).parents[2] / "examples" / "train_on_walks.py"
    outcome = subprocess.run([sys.executable, str(example), str(made)], capture_output=True, text=True, check=True)
    errors = [float(line.split()[2]) for line in outcome.stdout.splitlines()]
    assert len(errors) == 5
    assert errors[-1] < 0.5 * errors[0]


def test_tours_clips_and_models(tmp_path: Path) -> None:
    """Who tours a model of a place, walking as in a clip: the rows name both and hold neither."""
    (tmp_path / "clip.bvh").write_bytes(write_bvh(made_walk(), BvhRecipe(fps=FPS)))
    boxes: Boxes = {"Floor": ((0, -0.1, 0), (8.0, 0.2, 8.0)), "Table": ((1.5, 0.45, 1.5), (0.6, 0.9, 0.6))}
    write_place(tmp_path / "room.glb", boxes)
    spec = {
        "walks": 1, "seconds": 4, "places": ["room.glb"], "swings": ["clip.bvh"], "steering": ["tour"],
    }  # fmt: skip
    (tmp_path / "spec.json").write_text(json.dumps(spec))
    make_dataset(DatasetSpec.load(tmp_path / "spec.json"), tmp_path / "out", Here())
    (row,) = table(tmp_path / "out").to_pylist()
    assert (row["place"], row["swing"], row["steering"]) == ("room.glb", "clip.bvh", "tour")
    assert str(tmp_path) not in json.dumps(row)
    model = json.loads(row["scene"])["place"]
    assert model["file"] == "room.glb"
    assert not {"parts", "data"} & set(model)
    root = np.array(row["root"])
    assert np.ptp(root[:, :2], axis=0).max() > 1.0
    assert np.abs(row["height"]).max() < 0.05
    assert "clip.bvh" in (tmp_path / "out" / "README.md").read_text()


def test_the_report_counts_every_frame(made: Path, tmp_path: Path) -> None:
    page = tmp_path / "walks.html"
    outcome = CliRunner().invoke(app, ["dataset", "report", str(made), "-o", str(page), "-q"])
    assert outcome.exit_code == 0, outcome.output
    rows = table(made).to_pylist()
    near = np.concatenate([row["clearance"] for row in rows])
    assert f"{100.0 * np.mean(near < 0.045):.1f}" <= outcome.stdout.split("5 cm")[1].split("%")[0].strip()
    text = page.read_text()
    assert f"{len(rows)} walks" in text
    assert text.count('class="scene"') == len(rows)
    assert text.count('class="plot"') == len(Figures().all)
    assert "http" not in text.replace("http://www.w3.org", "")


def test_the_report_of_a_set_that_is_being_made_counts_what_was_drawn(made: Path, tmp_path: Path) -> None:
    for name, data in contents(made).items():
        (tmp_path / name).write_bytes(data)
    told = json.loads((tmp_path / "manifest.json").read_text())
    told["spec"]["walks"] *= 10
    (tmp_path / "manifest.json").write_text(json.dumps(told))
    write_report(tmp_path, tmp_path / "walks.html")
    assert f"of {told['shards'][-1]['end']} drawn" in (tmp_path / "walks.html").read_text()


@pytest.mark.long
def test_motion_is_small(tmp_path: Path) -> None:
    """At most 6 kB a second for configuration, contacts and clearance."""
    make_dataset(DatasetSpec(walks=1, seconds=6.0, places=("gauntlet:3",)), tmp_path, Here())
    (file,) = tmp_path.glob("*.parquet")
    found = pq.ParquetFile(file).metadata.row_group(0)
    columns = [found.column(k) for k in range(found.num_columns)]
    wanted = [c for c in columns if c.path_in_schema.split(".")[0] in ("q", "contacts", "clearance")]
    seconds = sum(table(tmp_path).column("frames").to_pylist()) / 30
    assert sum(column.total_compressed_size for column in wanted) / seconds < 6000


@pytest.mark.parametrize("call", [["chek", "walks"], ["look"]])
def test_a_word_that_is_no_command_is_no_spec(call: list[str]) -> None:
    outcome = CliRunner().invoke(app, ["dataset", *call])
    assert outcome.exit_code == 2
    assert f"No such command '{call[0]}'" in outcome.output


def test_check_finds_what_was_changed(made: Path, tmp_path: Path) -> None:
    assert check_dataset(made, Here(), 2).faults == ()
    for name, data in contents(made).items():
        (tmp_path / name).write_bytes(data)
    file = sorted(tmp_path.glob("*.parquet"))[0]
    damaged = bytearray(file.read_bytes())
    damaged[len(damaged) // 2] ^= 1
    file.write_bytes(damaged)
    (fault,) = check_dataset(tmp_path, Here(), 0).faults
    assert "SHA-256" in fault
    sorted(tmp_path.glob("*.parquet"))[1].unlink()
    assert len(check_dataset(tmp_path, Here(), 0).faults) == 2


def test_a_set_of_another_version_is_not_called_damaged(made: Path, tmp_path: Path) -> None:
    told = json.loads((made / "manifest.json").read_text("utf-8"))
    (tmp_path / "manifest.json").write_text(json.dumps(told | {"version": 99}), "utf-8")
    with pytest.raises(InputError, match="no manifest of a dataset of walks, version"):
        Manifest.of(tmp_path)


def test_check_walks_again(made: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    walk = WalkTask.run

    def other(task: WalkTask) -> Any:
        row = walk(task)
        assert not isinstance(row, str)
        row["q"][-1, 5] += 1e-6
        return row

    monkeypatch.setattr(WalkTask, "run", other)
    (fault,) = check_dataset(made, Here(), 1).faults
    assert fault.endswith("walked again, q differ")


def test_every_way_of_steering_that_a_spec_may_name_has_its_hand() -> None:
    assert tuple(HANDS) == STEERING


def test_draws_depend_on_nothing_but_seed_and_number() -> None:
    draws = [draw(SPEC, number) for number in range(200)]
    assert draws[7] == draw(replace(SPEC, walks=10_000), 7) != draw(replace(SPEC, seed=1), 7)
    assert {one.place for one in draws} == set(SPEC.places)
    assert {one.steering for one in draws} == set(SPEC.steering)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"walks": 0}, "walks: 0 is not between"),
        ({"fps": 25}, "fps: 25 is none of 60, 30, 20"),
        ({"places": "c"}, "places: 'c' is not of the kind"),
        ({"places": ["gauntlet:x"]}, "is not as gauntlet:3"),
        ({"places": ["gauntlet:9"]}, "level"),
        ({"steering": ["by foot"]}, "'by foot' is none of straight"),
        ({"swings": []}, "swings: give 1 to"),
        ({"speed": 3}, "'speed' is none of walks"),
        ({"seconds": True}, "seconds: 'True' is not of the kind"),
        ([], "is no JSON object"),
    ],
)
def test_wrong_specs_are_one_line(tmp_path: Path, given: Any, words: str) -> None:
    path = tmp_path / "spec.json"
    path.write_text(json.dumps(given))
    outcome = CliRunner().invoke(app, ["dataset", str(path), "-o", str(tmp_path / "out")])
    assert outcome.exit_code == 2
    assert words in outcome.stderr
    assert outcome.stderr.startswith(f"elbowroom: {path}: ")
    assert outcome.stderr.count("\n") == 1


def test_a_cut_spec_says_where_it_ends(tmp_path: Path) -> None:
    path = tmp_path / "spec.json"
    path.write_text('{"walks": 3,\n "seed": ')
    outcome = CliRunner().invoke(app, ["dataset", str(path), "-o", str(tmp_path / "out")])
    assert outcome.exit_code == 2
    assert outcome.stderr == f"elbowroom: {path}: line 2, column 10: not JSON: Expecting value\n"


def test_from_the_command_line(tmp_path: Path) -> None:
    path, out = tmp_path / "spec.json", tmp_path / "out"
    path.write_text(json.dumps({"walks": 9, "seconds": 1, "places": ["empty"]}))
    options = ["--walks", "1", "--jobs", "1", "-q", "--json"]
    outcome = CliRunner().invoke(app, ["dataset", str(path), "-o", str(out), *options])
    assert outcome.exit_code == 0, outcome.output
    assert json.loads(outcome.stdout) | {"bytes": 0} == {
        "walks": 1, "left_out": 0, "seconds": 1.0, "bytes": 0, "files": 1,
    }  # fmt: skip
    assert "infinite" in (out / "README.md").read_text()
    again = CliRunner().invoke(app, ["dataset", "check", str(out), "--sample", "1", "--jobs", "1", "-q", "--json"])
    assert (again.exit_code, json.loads(again.stdout)["faults"]) == (0, [])
    wrong = CliRunner().invoke(app, ["dataset", "check", str(out), "--show", "7", "-q"])
    assert (wrong.exit_code, "walk 7 is not between 0 and 0" in wrong.stderr) == (2, True)
    assert CliRunner().invoke(app, ["dataset", "check", str(tmp_path)]).exit_code == 2


def test_without_a_spec_it_is_said_what_is_missing() -> None:
    outcome = subprocess.run(
        [sys.executable, "-m", "elbowroom", "dataset"], capture_output=True, text=True, check=False
    )
    assert outcome.returncode == 2
    assert outcome.stderr.startswith("elbowroom: Missing command")
    assert outcome.stderr.count("\n") == 1


def test_the_stock_spec_is_read_and_every_column_explained() -> None:
    assert DatasetSpec.load(STOCK_SPEC).walks == 1000
    assert all(column.about for column in COLUMNS)


def test_a_folder_is_written_to_by_one_call_at_a_time(tmp_path: Path) -> None:
    with in_use(tmp_path), pytest.raises(InputError, match="another call is writing"):
        make_dataset(SPEC, tmp_path, Here())
    assert not list(tmp_path.iterdir())


def test_walks_that_are_there_are_never_thrown_away(tmp_path: Path) -> None:
    make_dataset(SPEC, tmp_path, Here())
    before = sorted(tmp_path.iterdir())
    with pytest.raises(InputError, match="holds 4 walks, not 2"):
        make_dataset(replace(SPEC, walks=2), tmp_path, Here())
    assert sorted(tmp_path.iterdir()) == before
