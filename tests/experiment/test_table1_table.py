"""Table 1: folded from trials, written as CSV and JSON."""

import csv
import json
import math
from dataclasses import replace

import numpy as np
import pytest

from elbowroom.errors import InputError
from elbowroom.experiment.crossing_settings import CrossingSettings
from elbowroom.experiment.paper_table import COLUMNS, paper_table
from elbowroom.experiment.statistics import wilson
from elbowroom.experiment.table1.cells import fold_cell
from elbowroom.experiment.table1.files import TIME_COLUMNS, columns, table_csv, table_document, trials_document
from elbowroom.experiment.table1.settings import Table1Settings
from elbowroom.experiment.table1.tasks import CrossingTask, crossing_tasks, scene_key
from shared_data import SHARED, needs_shared
from table1_records import ABOUT, made_up_table, made_up_trial

LIMIT = 30.0


def test_the_papers_table_is_complete() -> None:
    table = paper_table()
    assert list(table) == [(scene, queue) for scene in "abcd" for queue in range(3, 8)]
    assert table["c", 7].checks_per_plan == pytest.approx(74252 / 15.7)
    assert table["d", 3].pass_rate == 0.0
    assert table["d", 3].passed_time_s is None
    assert [key for key, cell in table.items() if cell.realtime is False] == [("c", 7), ("d", 6), ("d", 7)]


@needs_shared
def test_the_papers_table_is_the_papers() -> None:
    assert SHARED is not None
    rows = list(csv.DictReader((SHARED.parent / "paper" / "table1.csv").read_text().splitlines()))
    assert tuple(rows[0]) == COLUMNS
    for row in rows:
        cell = paper_table()[row["scene"].lower(), int(row["queue_size"])]
        for name in COLUMNS[2:-1]:
            assert getattr(cell, name) == (float(row[name]) if row[name] else None)
        assert cell.realtime == {"Y": True, "N": False, "": None}[row["realtime"]]


def test_a_cell_is_what_its_trials_say() -> None:
    rng = np.random.default_rng(0)
    trials = [made_up_trial("c", 5, seed, rng) for seed in range(1, 21)]
    cell = fold_cell(trials, LIMIT)
    passed = [trial for trial in trials if trial["passed"]]
    assert 0 < len(passed) < len(trials) == cell.trials
    assert cell.pass_rate.value == len(passed) / 20
    assert (cell.pass_rate.low, cell.pass_rate.high) == wilson(len(passed), 20)
    assert cell.straight_rate.value == sum(trial["straight"] for trial in trials) / 20
    for averages, chosen in ((cell.passed, passed), (cell.all, trials)):
        assert averages.trials == len(chosen)
        assert averages.stuck_times is not None
        assert averages.stuck_times.value == pytest.approx(np.mean([trial["stuck_times"] for trial in chosen]))
        assert averages.plan_success_rate is not None
        assert averages.plan_failed_rate == pytest.approx(1.0 - averages.plan_success_rate.value)
        assert averages.plan_success_rate.high <= 1.0
        checks, plans = (sum(trial[name] for trial in chosen) for name in ("collision_checks", "plans_total"))
        assert averages.checks_per_plan is not None
        assert averages.checks_per_plan.value == pytest.approx(checks / plans)
        assert averages.local_checks_per_plan is not None
        assert averages.local_checks_per_plan.value == pytest.approx(sum(t["local_checks"] for t in chosen) / plans)
        assert averages.time_s is not None
        times = [trial["passed_time_s"] or LIMIT for trial in chosen]
        assert averages.time_s.value == pytest.approx(np.mean(times))
        assert 0.0 <= averages.time_s.low < averages.time_s.value < averages.time_s.high <= LIMIT
    frames = [value for trial in trials for value in trial["frame_ms"]]
    assert cell.frame_ms.p99 == pytest.approx(np.percentile(frames, 99))
    assert cell.frame_ms.worst == max(frames)
    assert cell.plan_ms.worst == max(max(trial["plan_ms"]) for trial in trials)
    assert cell.realtime == all(trial["realtime"] for trial in trials)
    assert cell.punctual == all(trial["late_frames"] == 0 for trial in trials)


def test_a_cell_that_nobody_crossed_has_no_averages_over_crossings() -> None:
    rng = np.random.default_rng(1)
    trials = [made_up_trial("d", 3, seed, rng) | {"passed": False, "passed_time_s": None} for seed in (1, 2)]
    cell = fold_cell(trials, LIMIT)
    assert cell.passed.trials == 0
    assert cell.passed.stuck_times is None
    assert cell.passed.checks_per_plan is None
    assert cell.all.time_s is not None
    assert cell.all.time_s.value == LIMIT


def test_the_csv_has_the_papers_columns_first_then_times() -> None:
    table = made_up_table()
    rows = list(csv.DictReader(table_csv(table).splitlines()))
    header = tuple(rows[0])
    assert header == columns()
    assert header[: len(COLUMNS)] == COLUMNS
    assert header[len(COLUMNS) : len(COLUMNS) + 5] == (*TIME_COLUMNS, "planner")
    assert len(set(header)) == len(header)
    assert len(rows) == len(table.cells) == 12
    for row, cell in zip(rows, table.cells, strict=True):
        assert (row["scene"], int(row["queue_size"])) == (cell.scene.upper(), cell.queue_size)
        assert float(row["pass_rate"]) == pytest.approx(cell.pass_rate.value)
        assert row["realtime"] == ("Y" if cell.realtime else "N")
        assert row["passed_time_s"] == ("" if cell.passed.time_s is None else f"{cell.passed.time_s.value:.6g}")
        assert float(row["frame_ms_worst"]) == pytest.approx(cell.frame_ms.worst)
        assert float(row["stuck_times_all_high"]) >= float(row["stuck_times_all"])
        assert not any(value in ("nan", "inf", "None") for value in row.values())


def test_the_json_holds_every_trial_and_its_seed() -> None:
    table = made_up_table()
    document = json.loads(json.dumps(table_document(table, ABOUT) | trials_document(table)))
    assert document["date"] == ABOUT["date"]
    assert document["machine"] == ABOUT["machine"]
    assert len(document["trials"]) == 48
    told = {(trial["planner"], trial["scene"], trial["queue_size"], trial["seed"]) for trial in document["trials"]}
    assert told == {("figure6", scene, queue, seed) for scene in "abcd" for queue in (3, 5, 7) for seed in range(1, 5)}
    assert {"passed", "straight", "stuck_times", "collision_checks", "plan_ms"} <= document["trials"][0].keys()
    first = document["cells"][0]
    assert first["paper"]["stuck_times"] == 1.3
    assert first["pass_rate"].keys() == {"value", "low", "high"}
    assert {"passed", "all", "punctual", "realtime"} <= first.keys()
    assert len(document["canned_walk"]) == 4


def test_every_cell_gets_every_seed_and_no_trial_shares_a_key() -> None:
    settings = Table1Settings(seeds=3)
    tasks = list(crossing_tasks(settings))
    assert len({task.key for task in tasks}) == len(tasks) == 4 * 5 * 3
    assert {task.settings.seed for task in tasks} == {1, 2, 3}
    assert [task.settings.seed for task in tasks] == sorted(task.settings.seed for task in tasks)


def test_the_key_of_a_trial_knows_the_scene_by_its_content() -> None:
    task = CrossingTask("a", None, CrossingSettings(seed=1))
    assert scene_key("a") in task.key
    assert scene_key("a").partition("@")[2] != scene_key("b").partition("@")[2]
    assert task.key != replace(task, settings=CrossingSettings(seed=2)).key


@pytest.mark.parametrize(
    ("chosen", "word"),
    [
        ({"seeds": 0}, "seeds"),
        ({"queues": ()}, "queues"),
        ({"scenes": ("a", "a")}, "scenes"),
        ({"planners": ()}, "planners"),
    ],
)
def test_impossible_settings_are_plain_errors(chosen: dict[str, object], word: str) -> None:
    with pytest.raises(InputError, match=word):
        Table1Settings(**chosen)  # type: ignore[arg-type]


def test_one_trial_gives_no_interval_of_a_mean() -> None:
    cell = fold_cell(
        [made_up_trial("a", 3, 1, np.random.default_rng(2)) | {"passed": True, "passed_time_s": 5.0}], LIMIT
    )
    assert cell.all.stuck_times is not None
    assert math.isinf(cell.all.stuck_times.high)
