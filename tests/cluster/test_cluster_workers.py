"""A cluster of two nodes on this machine: the same results as in processes, each once, whatever is lost on the way."""

import os
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

ray = pytest.importorskip("ray", reason="needs Ray: pip install 'elbowroom[cluster]'")

from cluster_tasks import Death, Square  # noqa: E402
from elbowroom.cluster.connection import connected  # noqa: E402
from elbowroom.cluster.node import NodeKind, made_ready  # noqa: E402
from elbowroom.cluster.workers import RayWorkers  # noqa: E402
from elbowroom.errors import InputError  # noqa: E402
from elbowroom.experiment.gauntlet.runner import run_gauntlet  # noqa: E402
from elbowroom.experiment.gauntlet.settings import GauntletSettings  # noqa: E402
from elbowroom.experiment.parallel import Processes, ThisProcess  # noqa: E402

NODE: dict[str, Any] = {"num_cpus": 1, "object_store_memory": 100 * 2**20}


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    """Two nodes of one core each; a test may take nodes away and add others."""
    from ray.cluster_utils import Cluster

    paths = [str(Path(__file__).parents[1]), *os.environ.get("PYTHONPATH", "").split(os.pathsep)]  # of `cluster_tasks`
    os.environ |= {"RAY_USAGE_STATS_ENABLED": "0", "RAY_worker_niceness": "0", "PYTHONPATH": os.pathsep.join(paths)}
    made: Any = Cluster(initialize_head=True, head_node_args=NODE | {"include_dashboard": False})
    made.add_node(**NODE)
    yield made
    made.shutdown()


@pytest.fixture(scope="module")
def told() -> list[str]:
    return []


@pytest.fixture(scope="module")
def workers(cluster: Any, told: list[str]) -> Iterator[RayWorkers]:
    with connected(cluster.address, told.append) as found:
        yield found


def test_every_task_is_done_once_on_all_nodes(workers: RayWorkers, told: list[str]) -> None:
    nodes, until = set[str](), time.monotonic() + 60.0
    while len(nodes) < 2 and time.monotonic() < until:  # the workers of one may take longer to come than all of that
        results = list(workers.run([Square(number, 0.2) for number in range(16)]))
        assert sorted(place for place, _ in results) == list(range(16))
        assert {place: answer.value for place, answer in results} == {n: n * n for n in range(16)}
        assert os.getpid() not in {answer.process for _, answer in results}
        nodes |= {answer.node for _, answer in results}
    assert len(nodes) == 2
    assert told == []


def test_a_thing_travels_once_and_is_opened_here(workers: RayWorkers, tmp_path: Path) -> None:
    file = tmp_path / "bytes"
    file.write_bytes(b"\1\2\3")
    results = dict(workers.run([Square(n, 0.05, file) for n in range(8)]))
    assert {place: answer.value for place, answer in results.items()} == {n: n * n + 6 for n in range(8)}
    assert file.with_suffix(".opened").read_text() == "x"


def test_what_a_task_raises_is_raised_and_the_next_run_works(workers: RayWorkers) -> None:
    with pytest.raises(InputError, match=r"^-3 is negative$"):
        list(workers.run([Square(1), Square(-3)]))
    assert [answer.value for _, answer in workers.run([Square(3)])] == [9]


@pytest.mark.long
def test_a_worker_that_dies_costs_nothing(workers: RayWorkers, tmp_path: Path) -> None:
    assert list(workers.run([Death(tmp_path / "died")])) == [(0, "lives")]
    with pytest.raises(InputError, match="a task ended its worker 3 times"):
        list(workers.run([Death()]))


def test_nothing_to_do_and_runs_that_are_left_early(workers: RayWorkers) -> None:
    assert list(workers.run([])) == []
    run: Any = workers.run([Square(n, 0.1) for n in range(50)])
    next(run)
    run.close()
    assert [answer.value for _, answer in workers.run([Square(4)])] == [16]


@pytest.mark.long
def test_a_course_is_walked_as_in_this_process_to_the_bit(workers: RayWorkers, tmp_path: Path) -> None:
    settings = GauntletSettings(level=1, courses=1, seed=40, judge=True)
    far, near = run_gauntlet(settings, workers, tmp_path), run_gauntlet(settings, ThisProcess())
    assert [replace(walk, plan_ms=()) for walk in far.results] == [replace(walk, plan_ms=()) for walk in near.results]
    assert run_gauntlet(settings, _Nobody(), tmp_path).results == far.results  # all lies in the log


@pytest.mark.long
def test_a_node_that_is_taken_away_and_one_that_comes(cluster: Any, workers: RayWorkers, told: list[str]) -> None:
    """The last test here, since it leaves another cluster."""
    gone = cluster.worker_nodes.copy().pop()
    found: dict[int, Any] = {}
    for place, answer in workers.run([Square(number, 0.1) for number in range(60)]):
        assert place not in found
        found[place] = answer
        if len(found) == 10:
            assert gone.node_id in {answer.node for answer in found.values()}
            cluster.remove_node(gone, allow_graceful=False)
        if len(found) == 20:
            cluster.add_node(**NODE)
    assert {place: answer.value for place, answer in found.items()} == {n: n * n for n in range(60)}
    assert len([line for line in told if "is gone" in line]) == 1


class _Nobody(Processes):
    """Who is given nothing to do."""

    def run(self, tasks: Any) -> Iterator[Any]:
        assert not tasks
        yield from ()


def test_other_programs_and_processors_are_named() -> None:
    own = NodeKind.here()
    assert own.difference(own) == made_ready(own) == ""
    assert replace(own, version="9.9").difference(own) == f"its elbowroom is 9.9, here {own.version}"
    assert "its code is not that" in replace(own, program="x").difference(own)
    other = replace(own, machine=tuple((name, "z80") if name == "processor" else (name, v) for name, v in own.machine))
    assert other.difference(own) == f"its processor is z80, here {dict(own.machine)['processor']}"
    assert "here z80" in made_ready(other)
