"""`elbowroom tour`: to many places of a scene, one after the other, and what was shown judged."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from elbowroom.cli.options import clips as clip_options
from elbowroom.cli.options.arguments import check_arguments
from elbowroom.cli.options.avatar import Avatar, Bones, Height, IncludeHair, chosen_avatar, settings_by
from elbowroom.cli.options.going import told_place
from elbowroom.cli.options.place import Drop, GroundHeight, Passable, Scale, UpAxis, open_scene, place_options
from elbowroom.cli.telling.first_run import compile_first
from elbowroom.cli.telling.output import PLANNER_HELP, QUEUE_HELP, SCENE_HELP, print_json, print_row, progress_bar
from elbowroom.cli.telling.spoken import said
from elbowroom.clips.style_names import PLAIN_NAME
from elbowroom.errors import InputError
from elbowroom.experiment.crossing_settings import CrossingSettings
from elbowroom.planning.names import DEFAULT_PLANNER

if TYPE_CHECKING:
    from elbowroom.control.controller import Controller
    from elbowroom.experiment.judge.verdict import Verdict
    from elbowroom.experiment.tour.tour import Milliseconds, Shown, TourResult

EXAMPLES = "Examples:  elbowroom tour d  |  elbowroom tour house.glb --drop 'IfcDoor_*' --targets 20 --seed 3 --json"
FELL_SHORT = 1
MOST_TARGETS = 1000


def tour(
    scene: Annotated[str, typer.Argument(help=SCENE_HELP)],
    *,
    targets: Annotated[int, typer.Option(help="How many places are visited, drawn from all that can be reached.")] = 20,
    seed: Annotated[int, typer.Option(help="Draws the places, and the planner's chance.")] = 0,
    planner: Annotated[str, typer.Option(help=PLANNER_HELP)] = DEFAULT_PLANNER,
    queue: Annotated[int, typer.Option(help=QUEUE_HELP)] = 5,
    avatar: Avatar = None,
    bones: Bones = None,
    height: Height = None,
    include_hair: IncludeHair = False,
    record: Annotated[Path | None, typer.Option(help="Keep the run in this file, for `elbowroom replay`.")] = None,
    plan: Annotated[Path | None, typer.Option(help="Draw the tour from above into this PNG.")] = None,
    judge: Annotated[bool, typer.Option(help="Let coal judge what was shown, as `elbowroom verify` does.")] = True,
    mesh: Annotated[bool, typer.Option(help="Judge the avatar's own surface too, not only its capsules.")] = True,
    scale: Scale = None,
    up: UpAxis = None,
    ground: GroundHeight = None,
    drop: Drop = None,
    passable: Passable = None,
    style: clip_options.Style = PLAIN_NAME,
    swing: clip_options.Swing = None,
    dodge: clip_options.Dodge = None,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress on stderr.")] = False,
) -> None:
    """Visit random places of a scene on foot.

    Exit code 0: all were reached and nothing was touched, 1: not.
    """
    if not 1 <= targets <= MOST_TARGETS:
        raise InputError(f"--targets: {targets} is not between 1 and {MOST_TARGETS}")
    check_arguments(scenes=[scene], planners=[planner], queues=[queue], files=[avatar, bones], written=[record, plan])
    check_arguments(clips=clip_options.named_by(swing, dodge))
    told, reading = place_options(scale, up, ground, drop, passable), settings_by(bones, height, include_hair)
    settings = CrossingSettings(planner, queue, seed)
    from elbowroom.experiment.crossing import controller_for, warm_up

    compile_first(quiet=quiet)
    motions = clip_options.motions_by(swing, dodge, clip_options.told_by(None, None, None), style)
    place = open_scene(scene, told, quiet)
    with progress_bar(said("Opening the avatar"), None, quiet):
        humanoid = chosen_avatar(avatar, reading)
        controller = controller_for(humanoid, place, settings, motions)
        warm_up(controller)
    shown, result = _walked(controller, targets, record, quiet)
    verdict = _judged(shown, controller, result.seconds, mesh=mesh, quiet=quiet) if judge else None
    if plan is not None:
        _draw(plan, controller, shown, result)
    _report(result, verdict, json)
    touched = verdict is not None and not verdict.clean
    raise typer.Exit(FELL_SHORT if touched or result.arrived < result.targets else 0)


def _walked(controller: "Controller", count: int, record: Path | None, quiet: bool) -> "tuple[Shown, TourResult]":
    from contextlib import nullcontext

    from elbowroom.control.recordings.recording import Recorder
    from elbowroom.experiment.tour.targets import random_targets
    from elbowroom.experiment.tour.tour import Shown, run_tour
    from elbowroom.planning.command import Command

    start = controller.root.x, controller.root.height, controller.root.z
    places = random_targets(controller.navigator, start, count, controller.settings.seed)
    with (
        progress_bar(said("Touring {0}", controller.scene.title), float(count), quiet) as bar,
        nullcontext() if record is None else Recorder(record, controller) as recorder,
    ):
        shown = Shown(controller.step(Command(), 0.0), None if recorder is None else recorder.append)
        return shown, run_tour(
            controller, places, shown.append, lambda number, leg: bar.move(number + 1.0, f"{leg.outcome}")
        )


def _judged(shown: "Shown", controller: "Controller", seconds: float, *, mesh: bool, quiet: bool) -> "Verdict":
    from elbowroom.experiment.tour.tour import judged

    with progress_bar(said("Judging"), max(seconds, 1.0), quiet) as bar:
        return judged(shown, controller, mesh=mesh, progress=lambda time: bar.move(time, f"{time:.0f} s"))


def _draw(path: Path, controller: "Controller", shown: "Shown", result: "TourResult") -> None:
    from PIL import Image

    from elbowroom.experiment.tour.picture import tour_picture

    navigator = controller.navigator
    picture = tour_picture(navigator.room(), navigator.prices.slim, shown.motion().roots, result)
    try:
        Image.fromarray(picture).save(path, "PNG", optimize=True)
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be written ({error})") from None


def _report(result: "TourResult", verdict: "Verdict | None", json: bool) -> None:
    from dataclasses import asdict

    touching = None if verdict is None else _touching(verdict)
    if json:
        told = asdict(result) | {"touching_frames": touching}
        told["given_up"] = [asdict(leg) for leg in result.given_up]
        print_json(told | {"frames_judged": None if verdict is None else verdict.poses})
        return
    rows = {
        "arrived": said("{0} of {1}", result.arrived, result.targets),
        "stuck": said("{0} times, {1} s of {2} s", result.stuck, f"{result.stuck_s:.1f}", f"{result.seconds:.0f}"),
        "touching": "not judged" if verdict is None else said("{0} of {1} poses", touching, verdict.poses),
        "planning": _costs(result.plan_ms),
        "in processor time": _costs(result.plan_cpu_ms),
        "a frame": _costs(result.frame_ms),
        "without planning": _costs(result.frame_cpu_ms),
        "finding the way": _costs(result.find_ms),
    }
    print_row(said("Tour of {0}, seed {1}", result.scene, result.seed), rows)
    if result.given_up:
        lost = {told_place(leg.target): f"{leg.outcome}: {leg.reason}" for leg in result.given_up}
        print_row("Not reached", lost)


def _touching(verdict: "Verdict") -> int:
    """Poses in which the capsules or the surface touch."""
    return max(verdict.capsules.touching, 0 if verdict.mesh is None else verdict.mesh.touching)


def _costs(cost: "Milliseconds") -> str:
    return f"{cost.median:.2f} ms, 99 % {cost.p99:.1f}, worst {cost.worst:.1f} ({cost.count})"
