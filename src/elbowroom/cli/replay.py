"""`elbowroom replay`: a recording repeated bit for bit."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from elbowroom.cli.first_run import compile_first
from elbowroom.cli.output import print_json, progress_bar

if TYPE_CHECKING:
    from elbowroom.control.recording import Recording
    from elbowroom.control.replay import ReplayResult

EXAMPLES = "Examples:  elbowroom replay run.elbow  |  elbowroom replay run.elbow --avatar alice.vrm --json"
DIFFERENT = 1


def replay(
    recording: Annotated[Path, typer.Argument(help="A file written by `elbowroom walk --record`.")],
    *,
    avatar: Annotated[Path | None, typer.Option(help="The avatar's file, where it is not the stock one.")] = None,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress on stderr.")] = False,
) -> None:
    """Run the recorded commands again and compare every frame, bit for bit. Exit code 0: identical, 1: not."""
    from elbowroom.control.recording import Recording
    from elbowroom.control.replay import replay as run_again

    recorded = Recording(recording)
    compile_first(quiet=quiet)
    with progress_bar("Replaying", None, quiet) as bar:
        humanoid = recorded.header.avatar.load(avatar)
        result = run_again(recorded, humanoid, lambda done: bar.move(done, f"{done} frames"))
    _report(recorded, result, json)
    raise typer.Exit(0 if result.identical else DIFFERENT)


def _report(recorded: "Recording", result: "ReplayResult", json: bool) -> None:
    from elbowroom.control.recording import this_machine

    elsewhere = {key: value for key, value in recorded.header.machine.items() if this_machine().get(key) != value}
    if json:
        found = result.difference
        report = {
            "recording": str(recorded.path),
            "identical": result.identical,
            "frames": result.frames,
            "seconds": result.seconds,
            "first_difference": None if found is None else vars(found),
            "note": recorded.note,
            "recorded_elsewhere": elsewhere,
        }
        print_json(report)
        return
    if result.difference is None:
        print(f"identical: {result.frames} frames, {result.seconds:.1f} s")
    else:
        print(f"different from {result.difference}")
        if elsewhere:
            print("recorded with " + ", ".join(f"{key} {value}" for key, value in elsewhere.items()))
    if recorded.note is not None:
        print(f"note: {recorded.note}")
