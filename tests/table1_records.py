"""Made-up trials for tests of the table and its report."""

from pathlib import Path
from typing import Any

import numpy as np

from elbowroom.experiment.table1.cells import fold_canned, fold_cell
from elbowroom.experiment.table1.settings import Table1Settings
from elbowroom.experiment.table1.table import Table1

ABOUT: dict[str, Any] = {
    "command": "elbowroom table1 --seeds 4",
    "date": "2026-01-02",
    "machine": "2 x86_64 cores with AVX-512, Linux",
    "settings": {"jobs": 2},
    "identity": {
        "version": "0",
        "program": "p" * 64,
        "avatar": {"name": "<Stock> & co", "sha256": "a" * 64},
        "interval": 0.15,
    },
    "planner_settings": {"figure6": {"margin": 0.01, "waist": {"radius": 0.4}}},
}


def made_up_trial(
    scene: str, queue: int, seed: int, rng: np.random.Generator, planner: str = "figure6"
) -> dict[str, Any]:
    passed = bool(rng.random() < 0.7)
    stuck = int(rng.integers(0, 4))
    plans = int(rng.integers(10, 90))
    found = float(rng.random())
    return {
        "scene": scene,
        "planner": planner,
        "queue_size": queue,
        "seed": seed,
        "passed": passed,
        "straight": passed and stuck == 0,
        "stuck_times": stuck,
        "passed_time_s": float(rng.uniform(3, 29)) if passed else None,
        "plans_total": plans,
        "plan_success_rate": found,
        "plan_failed_rate": 1.0 - found,
        "collision_checks": int(rng.integers(1000, 90000)),
        "local_checks": int(rng.integers(500, 1000)),
        "realtime": bool(rng.random() < 0.9),
        "late_frames": int(rng.integers(0, 2)),
        "frames": 40,
        "frame_ms_p99": 1.0,
        "frame_ms_worst": 1.0,
        "plan_ms_worst": 1.0,
        "least_clearance": float(rng.uniform(0.0, 0.01)),
        "frame_ms": rng.lognormal(0.0, 1.0, 40).round(2).tolist(),
        "plan_ms": rng.lognormal(1.0, 1.0, plans).round(2).tolist(),
    }


def made_up_walk(scene: str, seed: int, rng: np.random.Generator) -> dict[str, Any]:
    touching = int(rng.integers(1, 50))
    return {
        "scene": scene,
        "seed": seed,
        "reached": True,
        "frames": 300,
        "touching_frames": touching,
        "deepest": float(rng.uniform(0.01, 0.05)),
    }


def made_up_table(settings: Table1Settings | None = None) -> Table1:
    chosen = settings or Table1Settings(queues=(3, 5, 7), seeds=4)
    rng = np.random.default_rng(7)
    seeds = range(1, chosen.seeds + 1)
    keys = [
        (planner, scene, queue) for planner in chosen.planners for scene in chosen.scenes for queue in chosen.queues
    ]
    rows = {key: [made_up_trial(key[1], key[2], seed, rng, key[0]) for seed in seeds] for key in keys}
    walks = {scene: [made_up_walk(scene, seed, rng) for seed in seeds] for scene in chosen.scenes}
    return Table1(
        chosen,
        cells=tuple(fold_cell(trials, chosen.limit) for trials in rows.values()),
        canned=tuple(fold_canned(trials) for trials in walks.values()),
        trials=tuple(trial for trials in rows.values() for trial in trials),
        canned_trials=tuple(walk for trials in walks.values() for walk in trials),
    )


SHORT_SCENE = {
    "format": "elbowroom-scene",
    "version": 1,
    "name": "short",
    "title": "Two <steps>",
    "description": "A short way past a box & a post.",
    "ground": {"size": [6, 6], "center": [0, 0]},
    "start": {"position": [0, 0], "heading": 0},
    "finish": {"position": [0, 0.8], "heading": 0},
    "obstacles": [
        {"type": "box", "name": "box", "center": [0.9, 0.5, 0.5], "size": [0.5, 1.0, 0.5], "yaw": 0.3},
        {"type": "box", "name": "post <thin>", "center": [-0.5, 1.0, 0.5], "size": [0.1, 2.0, 0.1]},
    ],
}


def results(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir() if not path.name.startswith("trials-"))
