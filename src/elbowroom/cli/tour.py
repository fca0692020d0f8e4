"""`elbowroom tour`: to many places of a scene, one after the other, and what was shown judged."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from elbowroom.cli.options import clips as clip_options
from elbowroom.cli.options.answers import Json, Quiet
from elbowroom.cli.options.arguments import check_arguments, check_judge
from elbowroom.cli.options.avatar import Avatar, Bones, Height, IncludeHair, settings_by
from elbowroom.cli.options.controller import chosen_controller
from elbowroom.cli.options.going import told_place
from elbowroom.cli.options.place import Drop, GroundHeight, Passable, Scale, UpAxis, open_scene, place_options
from elbowroom.cli.options.walking import SCENE_HELP, Planner, Queue, Record
from elbowroom.cli.telling.output import print_json, print_row
from elbowroom.cli.telling.spoken import said
from elbowroom.cli.telling.time_left import time_left_bar
from elbowroom.clips.style_names import PLAIN_NAME
from elbowroom.errors import InputError
from elbowroom.experiment.crossing_settings import CrossingSettings
from elbowroom.formats.file_bytes import check_ending
from elbowroom.planning.names import DEFAULT_PLANNER

if TYPE_CHECKING:
    from elbowroom.control.controller import Controller
    from elbowroom.experiment.judge.verdict import Verdict
    from elbowroom.experiment.tour.tour import FrameCollector, Milliseconds, TourResult

EXAMPLES = "Examples:  elbowroom tour d  |  elbowroom tour house.glb --drop 'IfcDoor_*' --targets 20 --seed 3 --json"
FELL_SHORT = 1
MOST_TARGETS = 1000
_NOT_JUDGED = {"touching": "not judged"}


def tour(
    scene: Annotated[str, typer.Argument(help=SCENE_HELP)],
    *,
    targets: Annotated[int, typer.Option(help="How many places are visited, drawn from all that can be reached.")] = 20,
    seed: Annotated[int, typer.Option(help="Draws the places, and the planner's chance.")] = 0,
    planner: Planner = DEFAULT_PLANNER,
    queue: Queue = 5,
    avatar: Avatar = None,
    bones: Bones = None,
    height: Height = None,
    include_hair: IncludeHair = False,
    record: Record = None,
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
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Visit random places of a scene on foot; what was shown is judged by coal (the extra `judge`).

    Exit code 0: all were reached and nothing was touched, 1: not.
    """
    if not 1 <= targets <= MOST_TARGETS:
        raise InputError(f"--targets: {targets} is not between 1 and {MOST_TARGETS}")
    check_arguments(scenes=[scene], planners=[planner], queues=[queue], files=[avatar, bones], written=[record, plan])
    check_arguments(clips=clip_options.named_by(swing, dodge))
    check_ending(plan, "a picture", ".png")
    if judge:
        check_judge("--no-judge")
    told, reading = place_options(scale, up, ground, drop, passable), settings_by(bones, height, include_hair)
    settings = CrossingSettings(planner, queue, seed)
    motions = clip_options.motions_by(swing, dodge, clip_options.told_by(None, None, None), style)
    place = open_scene(scene, told, quiet)
    controller = chosen_controller(avatar, reading, place, settings, motions, quiet=quiet)
    shown, result = _walked(controller, targets, record, quiet)
    if plan is not None:
        _draw(plan, controller, shown, result)
    if not json:
        _report(result, judge=judge)
    verdict = _judged(shown, controller, result, mesh=mesh, json=json, quiet=quiet) if judge else None
    if json and verdict is None:
        _print_json(result, None)
    touched = verdict is not None and not verdict.clean
    raise typer.Exit(FELL_SHORT if touched or result.arrived < result.targets else 0)


def _walked(
    controller: "Controller", count: int, record: Path | None, quiet: bool
) -> "tuple[FrameCollector, TourResult]":
    from contextlib import nullcontext

    from elbowroom.control.recordings.recording import Recorder
    from elbowroom.experiment.tour.targets import random_targets
    from elbowroom.experiment.tour.tour import FrameCollector, run_tour
    from elbowroom.planning.command import Command

    start = controller.root.x, controller.root.height, controller.root.z
    places = random_targets(controller.navigator, start, count, controller.settings.seed)
    with (
        time_left_bar(said("Touring {0}", controller.scene.title), quiet) as move,
        nullcontext() if record is None else Recorder(record, controller) as recorder,
    ):
        move(0, count)
        shown = FrameCollector(controller.step(Command(), 0.0), recorder)
        return shown, run_tour(controller, places, shown.append, lambda number, _leg: move(number + 1, count))


def _judged(
    shown: "FrameCollector", controller: "Controller", result: "TourResult", *, mesh: bool, json: bool, quiet: bool
) -> "Verdict":
    """The verdict, reported; one that is broken off too, with what was judged until then."""
    from elbowroom.experiment.tour.tour import judging

    walk = judging(shown, controller, mesh=mesh)
    try:
        with time_left_bar(said("Judging"), quiet) as move:
            for _ in walk.parts():
                move(walk.judged, walk.poses)
    finally:
        verdict = walk.verdict()
        if verdict.left:
            typer.echo(f"elbowroom: not judged to the end: {verdict.poses} of {walk.poses} poses", err=True)
        if json:
            _print_json(result, verdict)
        else:
            print_row("Judged by coal", _verdict_row(verdict))
    return verdict


def _draw(path: Path, controller: "Controller", shown: "FrameCollector", result: "TourResult") -> None:
    from PIL import Image

    from elbowroom.experiment.tour.picture import tour_picture

    navigator = controller.navigator
    picture = tour_picture(navigator.room(), navigator.prices.slim, shown.motion().roots, result)
    try:
        Image.fromarray(picture).save(path, "PNG", optimize=True)
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be written ({error})") from None


def _print_json(result: "TourResult", verdict: "Verdict | None") -> None:
    from dataclasses import asdict

    judged = {
        "touching_frames": None if verdict is None else _touching(verdict),
        "frames_judged": None if verdict is None else verdict.poses,
        "frames_not_judged": None if verdict is None else verdict.left,
    }
    print_json(asdict(result) | judged | {"given_up": [asdict(leg) for leg in result.given_up]})


def _report(result: "TourResult", *, judge: bool) -> None:
    rows = {
        "arrived": said("{0} of {1}", result.arrived, result.targets),
        "stuck": said("{0} times, {1} s of {2} s", result.stuck, f"{result.stuck_s:.1f}", f"{result.seconds:.0f}"),
        "planning": _costs(result.plan_ms),
        "in processor time": _costs(result.plan_cpu_ms),
        "a frame": _costs(result.frame_ms),
        "without planning": _costs(result.frame_cpu_ms),
        "finding the way": _costs(result.find_ms),
    }
    print_row(said("Tour of {0}, seed {1}", result.scene, result.seed), rows if judge else rows | _NOT_JUDGED)
    if result.given_up:
        lost = {told_place(leg.target): f"{leg.outcome}: {leg.reason}" for leg in result.given_up}
        print_row("Not reached", lost)


def _verdict_row(verdict: "Verdict") -> dict[str, str]:
    rows = {"touching": said("{0} of {1} poses", _touching(verdict), verdict.poses)}
    return rows | ({"not judged": str(verdict.left)} if verdict.left else {})


def _touching(verdict: "Verdict") -> int:
    """Poses in which the capsules or the surface touch."""
    return max(verdict.capsules.touching, 0 if verdict.mesh is None else verdict.mesh.touching)


def _costs(cost: "Milliseconds") -> str:
    return f"{cost.median:.2f} ms, 99 % {cost.p99:.1f}, worst {cost.worst:.1f} ({cost.count})"
