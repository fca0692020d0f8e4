"""`elbowroom gauntlet`: random courses that are feasible by construction."""

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from elbowroom.cli.gauntlet_place import Pieces, PlaceFile, chosen_place
from elbowroom.cli.options.answers import Json, Quiet
from elbowroom.cli.options.arguments import check_arguments, check_folder, check_judge
from elbowroom.cli.options.avatar import Avatar, Bones, Height, IncludeHair, chosen_avatar, settings_by
from elbowroom.cli.options.place import Drop, GroundHeight, Passable, Scale, UpAxis, open_scene, place_options
from elbowroom.cli.options.walking import Planner, Queue
from elbowroom.cli.options.workers import Cluster, Jobs, check_workers, chosen_workers
from elbowroom.cli.telling.first_run import compile_first
from elbowroom.cli.telling.output import (
    json_text,
    print_json,
    print_row,
    progress_bar,
    write_text,
)
from elbowroom.cli.telling.time_left import time_left_bar
from elbowroom.errors import InputError
from elbowroom.experiment.gauntlet.trial_settings import TrialSettings
from elbowroom.formats.file_bytes import check_ending
from elbowroom.planning.names import DEFAULT_PLANNER

if TYPE_CHECKING:
    from elbowroom.body.humanoid import Humanoid
    from elbowroom.control.recordings.avatar_reference import AvatarReference
    from elbowroom.experiment.gauntlet.place.furnished import FurnishedPlace
    from elbowroom.experiment.gauntlet.place.settings import PlaceGauntletSettings
    from elbowroom.experiment.gauntlet.runner import Progress
    from elbowroom.experiment.gauntlet.settings import Gauntlet, GauntletSettings
    from elbowroom.experiment.gauntlet.summary import GauntletSummary
    from elbowroom.experiment.gauntlet.trial import TrialResult
    from elbowroom.experiment.parallel import Workers
    from elbowroom.world.scene import Scene

EXAMPLES = (
    "Examples:  elbowroom gauntlet --level 3 --courses 50  |  elbowroom gauntlet --level 5 --show 2  |  "
    "elbowroom gauntlet --level 4 --save 7 course.json  |  elbowroom gauntlet --level 3 --avatar alice.vrm --judge  |  "
    "elbowroom gauntlet --place house.glb --drop 'IfcDoor_*' --courses 10"
)
FELL_SHORT = 1
_LISTED = 12  # seeds that are named


def gauntlet(
    *,
    level: Annotated[int, typer.Option(help="Difficulty, 1 to 5.")] = 1,
    courses: Annotated[int, typer.Option(help="How many courses; course K has the seed S + K.")] = 20,
    seed: Annotated[int, typer.Option(help="Seed of the first course; those after it count up.")] = 0,
    place: PlaceFile = None,
    pieces: Pieces = None,
    scale: Scale = None,
    up: UpAxis = None,
    ground: GroundHeight = None,
    drop: Drop = None,
    passable: Passable = None,
    planner: Planner = DEFAULT_PLANNER,
    queue: Queue = 5,
    jobs: Jobs = None,
    cluster: Cluster = None,
    out: Annotated[Path | None, typer.Option(help="Folder for results; an interrupted run goes on there.")] = None,
    judge: Annotated[bool, typer.Option("--judge", help="Have coal judge every walk: capsules and mesh.")] = False,
    shapes: Annotated[
        bool, typer.Option("--shapes", help="Cut most boxes down to spheres, capsules, cylinders and hulls.")
    ] = False,
    avatar: Avatar = None,
    bones: Bones = None,
    height: Height = None,
    include_hair: IncludeHair = False,
    save: Annotated[
        tuple[int, Path] | None, typer.Option(metavar="K FILE", help="Write course K as a scene file instead.")
    ] = None,
    show: Annotated[int | None, typer.Option(metavar="K", help="Open course K on the page instead.")] = None,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Walk random courses, each with a proof that this avatar's body can cross it, and count.

    With --place they lead through the model of a place, between its furniture, moved at random.
    Crossed: through in time; straight: and never stuck; stuck: at least once; stopped: not through, but never touching.
    A seed that gives this body no course is passed over and named.
    Exit code 0: all crossed and nothing touched, 1: not, 2: no seed gives a course.
    """
    check_arguments(planners=[planner], queues=[queue], level=level, files=[avatar, bones, place])
    check_folder(out)
    check_workers(cluster, jobs)
    if judge:
        check_judge()
    furnished = chosen_place(place, pieces, place_options(scale, up, ground, drop, passable), shapes=shapes)
    walker = _Walker(avatar, bones, height, include_hair)
    walker.check()
    _check_chosen(save, show, bones)
    gauntlet = _gauntlet(furnished, level, courses, seed, TrialSettings(planner, queue), judge=judge, shapes=shapes)
    gauntlet = replace(gauntlet, avatar=walker.reference())
    if furnished is not None:
        open_scene(str(furnished.path), furnished.options, quiet)  # which tells of a damaged one
    compile_first(quiet=quiet)
    if save is not None:
        return _save(_course(gauntlet, walker, save[0], quiet), save[1])
    if show is not None:
        return _show(_course(gauntlet, walker, show, quiet), gauntlet, walker)
    with chosen_workers(cluster, jobs, courses) as workers, time_left_bar("Courses", quiet) as move:
        summary = _walk_all(gauntlet, workers, out, move, json=json)
    raise typer.Exit(0 if _is_good(summary) else FELL_SHORT)


def _gauntlet(
    place: "FurnishedPlace | None",
    level: int,
    courses: int,
    seed: int,
    trial: TrialSettings,
    *,
    judge: bool,
    shapes: bool,
) -> "GauntletSettings | PlaceGauntletSettings":
    """The courses that the options ask for."""
    from elbowroom.experiment.gauntlet.place.settings import PlaceGauntletSettings
    from elbowroom.experiment.gauntlet.settings import GauntletSettings

    if place is not None:
        return PlaceGauntletSettings(place, courses, seed, trial, judge)
    return GauntletSettings(level, courses, seed, trial, judge, shapes=shapes)


def _walk_all(
    gauntlet: "Gauntlet", workers: "Workers", out: Path | None, move: "Progress", *, json: bool
) -> "GauntletSummary":
    """Walk, and say what came of it; raises `InputError` where no seed gives a course."""
    from elbowroom.experiment.gauntlet.runner import run_gauntlet
    from elbowroom.experiment.gauntlet.summary import GauntletSummary

    results, without = run_gauntlet(gauntlet, workers, out, move)
    missing = gauntlet.no_course.format(_listed(without))
    if not results:
        raise InputError(f"{gauntlet.title}: {missing}; try others")
    summary = GauntletSummary.of(results)
    document = _document(gauntlet, workers.at_once, summary) | {"without_course": list(without)} | _trials(results)
    if out is not None:
        write_text(out / f"gauntlet-{gauntlet.name}.json", json_text(document) + "\n")
    print_json(document) if json else _print(gauntlet, summary)
    if without:
        typer.echo(f"elbowroom: {missing}; the figures are of the others", err=True)
    return summary


def _is_good(summary: "GauntletSummary") -> bool:
    """Whether all courses were crossed and nothing touched."""
    touching = summary.touching_frames or summary.judged_touching or summary.mesh_touching
    return summary.crossed == summary.courses and not touching


def _listed(seeds: tuple[int, ...]) -> str:
    more = f" and {len(seeds) - _LISTED} more" if len(seeds) > _LISTED else ""
    return f"seed{'s' if len(seeds) > 1 else ''} {', '.join(map(str, seeds[:_LISTED]))}{more}"


class _Walker(NamedTuple):
    """The avatar that the options ask for."""

    avatar: Path | None
    bones: Path | None
    height: float | None
    include_hair: bool

    def check(self) -> None:
        """Raises `InputError` for options that no avatar can be read by."""
        settings_by(self.bones, self.height, self.include_hair)

    def load(self) -> "Humanoid":
        return chosen_avatar(self.avatar, settings_by(self.bones, self.height, self.include_hair))

    def reference(self) -> "AvatarReference | None":
        """How a process finds it; None for the stock avatar as it is."""
        from elbowroom.control.recordings.avatar_reference import AvatarReference

        return AvatarReference.of(self.load()) if any(option for option in self) else None


def _check_chosen(save: tuple[int, Path] | None, show: int | None, bones: Path | None) -> None:
    """Raises `InputError` for a course that there cannot be, or a file that it cannot be kept in."""
    if save is not None:
        check_arguments(files=[bones], written=[save[1]])
        check_ending(save[1], "a scene", ".json")
    for k in (show, None if save is None else save[0]):
        if k is not None and k < 0:
            raise InputError(f"course {k}: courses are counted from 0")


def _course(gauntlet: "Gauntlet", walker: _Walker, k: int, quiet: bool) -> "Scene":
    """Course `k` as a scene."""
    with progress_bar("Making the course", None, quiet):
        return gauntlet.scene(walker.load(), k)


def _save(course: "Scene", path: Path) -> None:
    write_text(path, json_text(course.to_dict()) + "\n")
    print(f"{path}: {course.title}")


def _show(course: "Scene", gauntlet: "Gauntlet", walker: _Walker) -> None:
    from elbowroom.cli.play import play

    with TemporaryDirectory() as folder:
        path = Path(folder) / f"{course.name}.json"
        write_text(path, json_text(course.to_dict()))
        play(
            host="127.0.0.1",
            port=8765,
            open_page=True,
            scene=str(path),
            **walker._asdict(),
            planner=gauntlet.trial.planner,
            queue=gauntlet.trial.queue_size,
        )


def _document(gauntlet: "Gauntlet", jobs: int, summary: "GauntletSummary") -> dict[str, Any]:
    from dataclasses import asdict

    from elbowroom.experiment.gauntlet.runner import identity
    from elbowroom.experiment.gauntlet.speeds import HumanSpeeds
    from elbowroom.experiment.statistics import wilson

    counts = asdict(summary)
    times = {name: counts.pop(f"plan_ms_{name}") for name in ("p50", "p99", "max")}
    rates = {name: list(wilson(counts[name], summary.courses)) for name in ("crossed", "straight", "stuck", "stopped")}
    return {
        **counts,
        "plan_ms": times,
        "intervals_95": rates,
        "settings": {
            **gauntlet.about(),
            "speeds": asdict(HumanSpeeds()),
            "courses": gauntlet.courses,
            "seed": gauntlet.seed,
            "jobs": jobs,
            **{name: value for name, value in identity(gauntlet).items() if name != "place"},
        },
    }


def _trials(results: list["TrialResult"]) -> dict[str, Any]:
    """Each walk without the list of its planning times."""
    from dataclasses import asdict

    return {"trials": [asdict(result) | {"plan_ms": max(result.plan_ms, default=0.0)} for result in results]}


def _print(gauntlet: "Gauntlet", summary: "GauntletSummary") -> None:
    def share(count: int) -> str:
        from elbowroom.experiment.statistics import wilson

        low, high = wilson(count, summary.courses)
        return f"{count} of {summary.courses}   95 %: {100 * low:5.1f} to {100 * high:5.1f} %"

    rows = {
        "crossed": share(summary.crossed),
        "straight": share(summary.straight),
        "stuck at least once": share(summary.stuck),
        "stopped short, touching nothing": share(summary.stopped),
        "times stuck": str(summary.stuck_times),
        "touching frames": f"{summary.touching_frames} of {summary.frames}",
        "least clearance": f"{1e3 * summary.least_clearance:.1f} mm",
        "planning, ms: median, 99 %, worst": (
            f"{summary.plan_ms_p50:.2f}, {summary.plan_ms_p99:.2f}, {summary.plan_ms_max:.2f}"
        ),
    }
    if summary.judged_poses is not None:
        rows["touching poses, by the judge"] = f"{summary.judged_touching} of {summary.judged_poses}"
        rows["poses that touch themselves"] = str(summary.judged_self_touching)
    if summary.mesh_touching is not None and summary.mesh_deepest is not None:
        deepest = f", up to {1e3 * summary.mesh_deepest:.1f} mm deep" if summary.mesh_touching else ""
        rows["poses in which the mesh touches"] = f"{summary.mesh_touching} of {summary.judged_poses}{deepest}"
        if summary.mesh_clearance is not None:
            rows["least clearance of the mesh"] = f"{1e3 * summary.mesh_clearance:.1f} mm"
    last = gauntlet.seed + gauntlet.courses - 1
    about = f"{gauntlet.title}, seeds {gauntlet.seed} to {last}"
    trial = gauntlet.trial
    print_row(f"Gauntlet, {about}, {trial.planner}, |Q| {trial.queue_size}", rows)
