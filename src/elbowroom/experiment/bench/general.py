"""A general planner on the crossing problem: OMPL's RRT-Connect, in a process of its own."""

import os
from dataclasses import dataclass
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.errors import InputError
from elbowroom.experiment.bench.general_problem import SECOND, CrossingProblem, crossing_problem
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class GeneralPlan:
    """How it ended."""

    states: Floats  # (n, d + 1); (0, d + 1) where none was found
    seconds: float  # of planning
    motions: int  # that were checked

    @property
    def found(self) -> bool:
        """Whether there is a plan."""
        return len(self.states) > 0

    def shown(self, problem: CrossingProblem) -> ShownMotion:
        """The plan as frames, 60 a second."""
        times = np.arange(0.0, self.states[-1, -1], 1 / 60)
        columns = [np.interp(times, self.states[:, -1], column) for column in self.states.T]
        q, roots = problem.postures(np.stack(columns, axis=1))
        return ShownMotion.at_rate(q, roots)


def check_installed() -> None:
    """Raises `InputError` where OMPL is missing."""
    try:
        import ompl  # noqa: F401
    except ImportError:
        raise InputError('the general planner needs OMPL: pip install "elbowroom[bench]"') from None


def plan_generally(humanoid: Humanoid, scene: Scene, limit: float, seed: int) -> GeneralPlan:
    """Let RRT-Connect try for `limit` seconds.

    It runs in a fresh process, because its random seed can be set only once in each.
    """
    import multiprocessing

    check_installed()
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe(duplex=False)
    child = context.Process(target=_solve_and_send, args=(humanoid, scene, limit, seed, theirs), daemon=True)
    child.start()
    theirs.close()
    try:
        plan = ours.recv()
    except EOFError:
        raise InputError("the general planner's process died") from None
    finally:
        child.join()
    assert isinstance(plan, GeneralPlan)
    return plan


def _solve_and_send(humanoid: Humanoid, scene: Scene, limit: float, seed: int, pipe: Any) -> None:
    pipe.send(solve(crossing_problem(humanoid, scene), limit, seed))
    pipe.close()
    os._exit(0)  # without the binding's long complaint about what it leaks


def solve(problem: CrossingProblem, limit: float, seed: int) -> GeneralPlan:
    """RRT-Connect on the problem; the seed counts for the first call in a process."""
    from ompl import base, geometric, util

    util.setLogLevel(util.LogLevel.LOG_NONE)
    util.RNG.setSeed(seed + 1)  # 0 means a seed of OMPL's own choice
    size = len(problem.start)
    space, bounds = base.RealVectorStateSpace(size), base.RealVectorBounds(size)
    scale = np.append(np.ones(size - 1), SECOND)
    for i in range(size):
        bounds.setLow(i, float(problem.low[i] * scale[i]))
        bounds.setHigh(i, float(problem.high[i] * scale[i]))
    space.setBounds(bounds)
    information = base.SpaceInformation(space)

    def row(state: Any) -> Floats:
        values: Floats = np.array([state[i] for i in range(size)]) / scale
        return values

    class Motions(base.MotionValidator):  # type: ignore[misc]
        """Free all the way, forward in time, within the speeds."""

        checked = 0

        def checkMotion(self, first: Any, second: Any, *_: Any) -> bool:  # noqa: N802 (the library's name)
            self.checked += 1
            a, b = row(first), row(second)
            return problem.is_slow_enough(a, b) and problem.is_free(problem.sampled(a, b))

    motions = Motions(information)
    information.setStateValidityChecker(lambda state: problem.is_free(row(state)[None]))
    information.setMotionValidator(motions)
    information.setup()
    definition = base.ProblemDefinition(information)
    ends = [space.allocState(), space.allocState()]
    for state, values in zip(ends, (problem.start * scale, problem.goal * scale), strict=True):
        for i, value in enumerate(values):
            state[i] = float(value)
    definition.setStartAndGoalStates(*ends)
    planner = geometric.RRTConnect(information)
    planner.setProblemDefinition(definition)
    planner.setup()
    began = perf_counter()
    planner.solve(limit)
    seconds = perf_counter() - began
    states = np.empty((0, size))
    if definition.hasExactSolution():
        path = definition.getSolutionPath()
        states = np.stack([row(path.getState(k)) for k in range(path.getStateCount())])
    return GeneralPlan(states, seconds, motions.checked)
