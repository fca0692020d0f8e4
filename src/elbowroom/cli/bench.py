"""`elbowroom bench`: what the parts cost that a frame waits for."""

import typer

from elbowroom.cli import bench_collision

bench = typer.Typer(
    help="Measure speeds: `collision` the kernel beside other libraries.",
    no_args_is_help=True,
)
bench.command("collision", epilog=bench_collision.EXAMPLES)(bench_collision.collision)
