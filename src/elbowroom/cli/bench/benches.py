"""`elbowroom bench`: what the parts cost that a frame waits for."""

import typer

from elbowroom.cli.bench import cluster as bench_cluster
from elbowroom.cli.bench import collision as bench_collision
from elbowroom.cli.bench import compile as bench_compile
from elbowroom.cli.bench import crowd as bench_crowd
from elbowroom.cli.bench import meet as bench_meet
from elbowroom.cli.bench import motion as bench_motion
from elbowroom.cli.bench import plan as bench_plan
from elbowroom.cli.bench import planners as bench_planners
from elbowroom.cli.bench import steer as bench_steer
from elbowroom.cli.options.answers import Json
from elbowroom.cli.telling.output import print_json
from elbowroom.experiment.bench.settings import CollisionSettings, PlanSettings

EXAMPLES = "Examples:  elbowroom bench  |  elbowroom bench --json  |  elbowroom bench plan --scene d"

bench = typer.Typer(help="Measure speeds; without a command, of the collision kernel and of planning.")


@bench.callback(invoke_without_command=True, epilog=EXAMPLES)
def both(
    context: typer.Context,
    *,
    json: Json = False,
) -> None:
    """Measure speeds; without a command, of the collision kernel and of planning."""
    if context.invoked_subcommand is not None:
        return
    from elbowroom.experiment.bench import collision, plan

    sizes = CollisionSettings()
    of_collision, of_planning = collision.run(sizes), plan.run(PlanSettings())
    if json:
        found = {"collision": bench_collision.as_json(of_collision, sizes.seed), "plan": of_planning.as_dict()}
        print_json(found)
        return
    bench_collision.show(of_collision)
    bench_plan.show(of_planning)


bench.command("collision", epilog=bench_collision.EXAMPLES)(bench_collision.collision)
bench.command("plan", epilog=bench_plan.EXAMPLES)(bench_plan.plan)
bench.command("planners", epilog=bench_planners.EXAMPLES)(bench_planners.planners)
bench.command("crowd", epilog=bench_crowd.EXAMPLES)(bench_crowd.crowd)
bench.command("cluster", epilog=bench_cluster.EXAMPLES)(bench_cluster.cluster)
bench.command("steer", epilog=bench_steer.EXAMPLES)(bench_steer.steer)
bench.command("meet", epilog=bench_meet.EXAMPLES)(bench_meet.meet)
bench.command("motion", epilog=bench_motion.EXAMPLES)(bench_motion.motion)
bench.command("compile", epilog=bench_compile.EXAMPLES)(bench_compile.compile_)
