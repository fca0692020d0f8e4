"""What the walks through many courses add up to."""

from collections.abc import Sequence
from dataclasses import dataclass

from elbowroom.experiment.gauntlet.trial import TrialResult
from elbowroom.experiment.statistics import percentile


@dataclass(frozen=True)
class GauntletSummary:
    """Counts over courses, and the cost of planning."""

    courses: int
    crossed: int  # through within the limit
    straight: int  # through, and never stuck
    stuck: int  # courses on which the avatar was stuck at least once
    stopped: int  # not through in time, and never touching
    touching: int  # courses with a touching frame
    stuck_times: int  # over all courses
    touching_frames: int  # over all courses
    frames: int
    least_clearance: float  # metres, over all courses
    collision_checks: int
    plan_ms_p50: float
    plan_ms_p99: float
    plan_ms_max: float
    judged_poses: int | None  # None unless the judge looked at every walk
    judged_touching: int | None
    judged_self_touching: int | None  # poses with parts of the body in each other
    mesh_touching: int | None  # of the judged poses; None unless the avatar's own surface was judged too
    mesh_deepest: float | None  # metres
    mesh_clearance: float | None  # metres, the least over all courses

    @classmethod
    def of(cls, results: Sequence[TrialResult]) -> "GauntletSummary":
        """Add up results."""
        figures = [result.judge for result in results if result.judge is not None]
        judged = len(figures) == len(results) > 0
        meshes = [figure.mesh_touching for figure in figures if figure.mesh_touching is not None]
        mesh_judged = judged and len(meshes) == len(figures)
        gaps = [figure.mesh_clearance for figure in figures if figure.mesh_clearance is not None]
        costs = [cost for result in results for cost in result.plan_ms]
        return cls(
            courses=len(results),
            crossed=sum(result.crossed for result in results),
            straight=sum(result.straight for result in results),
            stuck=sum(result.stuck_times > 0 for result in results),
            stopped=sum(result.stopped for result in results),
            touching=sum(result.touching_frames > 0 for result in results),
            stuck_times=sum(result.stuck_times for result in results),
            touching_frames=sum(result.touching_frames for result in results),
            frames=sum(result.frames for result in results),
            least_clearance=min((result.least_clearance for result in results), default=float("inf")),
            collision_checks=sum(result.collision_checks for result in results),
            plan_ms_p50=round(percentile(costs, 50.0), 3),
            plan_ms_p99=round(percentile(costs, 99.0), 3),
            plan_ms_max=round(percentile(costs, 100.0), 3),
            judged_poses=sum(figure.poses for figure in figures) if judged else None,
            judged_touching=sum(figure.touching for figure in figures) if judged else None,
            judged_self_touching=sum(figure.self_touching for figure in figures) if judged else None,
            mesh_touching=sum(meshes) if mesh_judged else None,
            mesh_deepest=max(figure.mesh_deepest or 0.0 for figure in figures) if mesh_judged else None,
            mesh_clearance=min(gaps) if mesh_judged and gaps else None,
        )
