"""`elbowroom dataset`: walks for those who train and evaluate, in Parquet files."""

from functools import partial
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperGroup

from elbowroom.cli.options.answers import Json, Quiet
from elbowroom.cli.options.arguments import check_arguments, check_folder, check_judge
from elbowroom.cli.options.workers import Cluster, Jobs, check_workers, chosen_workers
from elbowroom.cli.telling.first_run import compile_first
from elbowroom.cli.telling.output import print_json, print_row
from elbowroom.cli.telling.time_left import time_left_bar
from elbowroom.errors import InputError
from elbowroom.formats.file_bytes import check_ending

if TYPE_CHECKING:
    from elbowroom.dataset.spec import DatasetSpec

EXAMPLES = (
    "Examples:  elbowroom dataset examples/dataset.json -o walks --walks 100  |  elbowroom dataset check walks  |  "
    "elbowroom dataset check walks --show 7  |  elbowroom dataset report walks"
)
FELL_SHORT = 1
Folder = Annotated[Path, typer.Argument(help="Folder of a dataset.")]


class _OrMake(TyperGroup):
    """`elbowroom dataset SPEC.json` makes one."""

    default = "make"

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        first = args[0] if args else ""
        spec = first.startswith("-") or Path(first).suffix != "" or Path(first).is_file()
        anew = spec and first not in (*self.commands, *ctx.help_option_names)
        return super().parse_args(ctx, [self.default, *args] if anew else args)


_HELP = "Make, check and look at datasets of walks; `dataset SPEC.json` is `dataset make SPEC.json`."
dataset = typer.Typer(cls=_OrMake, help=_HELP, epilog=EXAMPLES)


@dataset.command(epilog=EXAMPLES)
def make(
    spec: Annotated[Path, typer.Argument(help="JSON file that says what is drawn; examples/dataset.json is one.")],
    *,
    out: Annotated[Path, typer.Option("--out", "-o", help="Folder; an interrupted run goes on there.")],
    walks: Annotated[int | None, typer.Option(help="How many are drawn, instead of the spec's number.")] = None,
    jobs: Jobs = None,
    cluster: Cluster = None,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Draw walks by a seed, walk them, have each judged by coal, and keep the clean ones in Parquet files.

    The same call again goes on where it was interrupted; more `--walks` add to what is there.
    """
    from dataclasses import replace

    check_arguments(files=[spec])
    check_folder(out)
    check_workers(cluster, jobs)
    _check_installed()
    from elbowroom.dataset.spec import DatasetSpec

    wanted = DatasetSpec.load(spec)
    wanted = wanted if walks is None else replace(wanted, walks=walks)
    from elbowroom.dataset.drawn_from import check_drawn_from

    check_drawn_from(wanted, spec)
    from elbowroom.dataset.card import check_licences
    from elbowroom.dataset.make import make_dataset

    check_licences(wanted)
    compile_first(quiet=quiet)
    with chosen_workers(cluster, jobs, wanted.walks) as workers, time_left_bar("Walks", quiet) as move:
        manifest = make_dataset(wanted, out, workers, move)
    kept, left_out = sum(one.walks for one in manifest.shards), sum(len(one.rejected) for one in manifest.shards)
    seconds, size = sum(one.seconds for one in manifest.shards), sum(one.bytes for one in manifest.shards)
    if json:
        found = {"walks": kept, "left_out": left_out, "seconds": seconds, "bytes": size, "files": len(manifest.shards)}
        print_json(found)
        return
    rows = {
        "walks": f"{kept}, {left_out} left out",
        "motion": f"{seconds / 60:.1f} minutes at {wanted.fps} frames a second",
        "files": f"{len(manifest.shards)}, {size / 1e6:.1f} MB",
    }
    print_row(str(out), rows)


@dataset.command(epilog=EXAMPLES)
def check(
    folder: Folder,
    *,
    sample: Annotated[int, typer.Option(help="Walks that are walked again.")] = 5,
    show: Annotated[int | None, typer.Option(metavar="K", help="Open walk K on the page instead.")] = None,
    jobs: Jobs = None,
    cluster: Cluster = None,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Compare sums and columns, and walk a sample again, bit for bit. Exit code 1: something differs."""
    check_workers(cluster, jobs)
    _check_installed()
    if sample < 0:
        raise InputError(f"sample: {sample} is less than 0")
    from elbowroom.dataset.manifest import FILE, Manifest

    manifest = Manifest.of(folder)
    if show is not None:
        if (why := manifest.why_left_out(show)) is not None:
            typer.echo(f"elbowroom: walk {show} was left out of the files: {why}", err=True)
        return _show(manifest.spec, show)
    if sample:
        from elbowroom.dataset.drawn_from import check_drawn_from

        check_drawn_from(manifest.spec, folder / FILE)
    compile_first(quiet=quiet)
    from elbowroom.dataset.check import check_dataset

    with chosen_workers(cluster, jobs, max(sample, 1)) as workers, time_left_bar("Walking again", quiet) as move:
        found = check_dataset(folder, workers, sample, move)
    if json:
        print_json(found._asdict())
    else:
        for fault in found.faults:
            print(fault)
        rows = {"files": f"{found.files}", "walks": f"{found.walks}, {found.walked} walked again"}
        print_row(f"{folder}: {'whole' if not found.faults else f'{len(found.faults)} faults'}", rows)
    raise typer.Exit(FELL_SHORT if found.faults else 0)


@dataset.command(epilog=EXAMPLES)
def report(
    folder: Folder,
    *,
    out: Annotated[Path, typer.Option("--out", "-o", help="Page that is written.")] = Path("walks.html"),
    quiet: Quiet = False,
) -> None:
    """Draw how near, how fast and in which postures is walked, and some walks from above, on one page."""
    _check_installed()
    check_arguments(written=[out])
    check_ending(out, "a page", ".html", ".htm")
    from elbowroom.dataset.manifest import Manifest

    Manifest.of(folder)
    from elbowroom.dataset.report import write_report

    with time_left_bar("Files", quiet) as move:
        figures = write_report(folder, out, move)
    rows = {
        "nearer than 5 cm": f"{figures.clearance.share(0.0, 5.0):.1%} of all frames",
        "standing": f"{figures.speed.share(0.0, 0.05):.1%}",
    }
    print_row(str(out), rows)


def _show(spec: "DatasetSpec", walk: int) -> None:
    """Walk one walk again and show it on the page, with its timeline, until Ctrl-C."""
    if not 0 <= walk < spec.walks:
        raise InputError(f"--show: walk {walk} is not between 0 and {spec.walks - 1}")
    from elbowroom.cli.play import serve_until_interrupted
    from elbowroom.cli.replay import library_of
    from elbowroom.control.recordings.recording import Recording
    from elbowroom.dataset.draw import draw
    from elbowroom.dataset.recorded import record_walk
    from elbowroom.dataset.spec import STOCK

    compile_first()
    name = draw(spec, walk).avatar
    with TemporaryDirectory() as place:
        path = Path(place) / f"walk-{walk}.elbow"
        record_walk(spec, walk, path)
        library = partial(library_of, Recording(path), None if name == STOCK else Path(name))
        serve_until_interrupted(library, "127.0.0.1", 8765, open_page=True, query="replay")


def _check_installed() -> None:
    if find_spec("pyarrow") is None:
        raise InputError("datasets need pyarrow: pip install 'elbowroom[dataset]'")
    check_judge()
