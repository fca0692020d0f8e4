"""`elbowroom bench`: what the parts cost that a frame waits for."""

import typer

from elbowroom.cli import bench_collision, bench_planners

bench = typer.Typer(
    help="Measure: `collision` the kernel beside other libraries, `planners` ours beside a general one.",
    no_args_is_help=True,
)
bench.command("collision", epilog=bench_collision.EXAMPLES)(bench_collision.collision)
bench.command("planners", epilog=bench_planners.EXAMPLES)(bench_planners.planners)
