"""`elbowroom bench collision`: capsule-box and capsule-mesh checks a second, beside other libraries."""

from typing import TYPE_CHECKING, Annotated, Any

import typer

from elbowroom.cli.options.answers import Json, Quiet
from elbowroom.cli.telling.output import print_json, print_row, progress_bar
from elbowroom.experiment.bench.settings import CollisionSettings, MeshSettings

if TYPE_CHECKING:
    from elbowroom.experiment.bench.collision import CollisionReport, Speed

EXAMPLES = "Examples:  elbowroom bench collision  |  elbowroom bench collision --mesh --json"


def collision(
    *,
    postures: Annotated[int, typer.Option(help="Postures of an arm of three capsules.")] = 10_000,
    boxes: Annotated[int, typer.Option(help="How many boxes stand round the avatar.")] = 6,
    rounds: Annotated[int, typer.Option(help="Times that each library runs; the median counts.")] = 7,
    seed: Annotated[int, typer.Option(help="Seed of the random postures and boxes.")] = 7,
    mesh: Annotated[bool, typer.Option("--mesh", help="Against a mesh of 100,000 triangles.")] = False,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Measure how many capsules a second are checked against boxes or a mesh, on one core, and whether others agree."""
    if mesh:
        _meshes(postures, rounds, seed, json, quiet)
        return
    settings = CollisionSettings(postures=postures, boxes=boxes, rounds=rounds, seed=seed)
    from elbowroom.experiment.bench.collision import run

    with progress_bar("Checking", rounds, quiet) as bar:
        report = run(settings, bar.move)
    if json:
        print_json(as_json(report, settings.seed))
    else:
        show(report)


def _meshes(postures: int, rounds: int, seed: int, json: bool, quiet: bool) -> None:
    """Capsules against triangles."""
    settings = MeshSettings(postures=postures, rounds=rounds, seed=seed)
    from dataclasses import asdict

    from elbowroom.experiment.bench.mesh_collision import run
    from elbowroom.experiment.machine import machine_kind

    with progress_bar("Checking", rounds, quiet) as bar:
        report = run(settings, bar.move)
    if json:
        print_json({"machine": machine_kind(), "seed": seed} | asdict(report))
        return
    rows = {report.own.name: _millions(report.own)}
    rows |= {
        rival.name: f"{_millions(rival)}, ours {rival.ratio or 0.0:.0f} times; {rival.disagreements} other answers"
        for rival in report.rivals
    }
    rows |= dict.fromkeys(report.missing, "not installed")
    rows["held against every triangle"] = (
        f"{report.checks} checks, {report.touching_share:.0%} touch; {report.false_free} falsely free, "
        f"{report.false_touching} falsely touching"
    )
    print_row(f"Capsule-mesh checks a second on one core, {report.triangles} triangles ({machine_kind()})", rows)


def as_json(report: "CollisionReport", seed: int) -> dict[str, Any]:
    """All that is shown, and the setting."""
    from dataclasses import asdict

    from elbowroom.experiment.machine import machine_kind

    return {"machine": machine_kind(), "seed": seed} | asdict(report)


def show(report: "CollisionReport") -> None:
    """The figures as a table."""
    from elbowroom.experiment.bench.frame_check import FEW, MANY
    from elbowroom.experiment.machine import machine_kind

    bits = f"{report.vector_bits}-bit vectors" if report.vector_bits else "scalar or unknown machine code"
    rows = {report.own.name: f"{_millions(report.own)}, {bits}"}
    rows |= {
        rival.name: f"{_millions(rival)}, ours {rival.ratio or 0.0:.0f} times; {rival.disagreements} other answers"
        for rival in report.rivals
    }
    rows |= dict.fromkeys(report.missing, "not installed")
    shaped = {f"{report.own.name}: {speed.name}": _millions(speed) for speed in report.shapes}
    frame = report.frame
    shaped["the check of a frame"] = (
        f"{1e3 * frame.few_ms:.0f} µs among {FEW} boxes, {1e3 * frame.many_ms:.0f} µs among {MANY}: "
        f"{frame.ratio:.2f} times"
    )
    print_row(f"Capsule-box checks a second on one core ({machine_kind()})", rows | shaped)


def _millions(speed: "Speed") -> str:
    return f"{speed.checks_per_second / 1e6:.3g} million"
