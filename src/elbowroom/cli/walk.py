"""`elbowroom walk`: the paper's crossing test, without a screen."""

from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from elbowroom.cli.options import clips as clip_options
from elbowroom.cli.options import vmc as vmc_options
from elbowroom.cli.options.answers import Json, Quiet
from elbowroom.cli.options.arguments import check_arguments
from elbowroom.cli.options.avatar import Avatar, Bones, Height, IncludeHair, settings_by
from elbowroom.cli.options.controller import chosen_controller
from elbowroom.cli.options.going import TO_HELP, place_of, report_leg
from elbowroom.cli.options.place import Drop, GroundHeight, Passable, Scale, is_model, open_scene, place_options
from elbowroom.cli.options.vmc import check_vmc, in_time, stream_to
from elbowroom.cli.options.walking import Planner, Queue, Record, SceneName
from elbowroom.cli.telling.output import Bar, print_json, print_row, progress_bar
from elbowroom.cli.telling.spoken import said
from elbowroom.clips.style_names import PLAIN_NAME
from elbowroom.experiment.crossing_settings import CrossingSettings
from elbowroom.planning.names import DEFAULT_PLANNER

if TYPE_CHECKING:
    from elbowroom.body.humanoid import Humanoid
    from elbowroom.control.controller import Controller
    from elbowroom.control.frame import Frame
    from elbowroom.control.recordings.recording import Recorder
    from elbowroom.experiment.crossing import CrossingResult
    from elbowroom.experiment.listener import Listener
    from elbowroom.experiment.tour.leg import Leg
    from elbowroom.planning.navigation.way import Place, Spot
    from elbowroom.server.vmc.stream import VmcStream

EXAMPLES = "Examples:  elbowroom walk --scene d --record run.elbow --json  |  elbowroom walk --scene a --to 1,6"
FELL_SHORT = 1
_FRAMES_PER_UPDATE = 30
_TITLE = "Scene {0}, {1}, |Q| {2}, seed {3}"
_LATE = "{0}: {1} of {2} frames over 1/60 s late"
_PAPERS = {True: "more than one frame in every second", False: "a second with one frame or none"}


def walk(
    *,
    scene: SceneName = "a",
    planner: Planner = DEFAULT_PLANNER,
    queue: Queue = 5,
    seed: Annotated[int, typer.Option(help="Varies the planner's chance, the start and the user's patience.")] = 0,
    avatar: Avatar = None,
    bones: Bones = None,
    height: Height = None,
    include_hair: IncludeHair = False,
    limit: Annotated[float, typer.Option(help="Seconds that the user has for the crossing.")] = 30.0,
    to: Annotated[str | None, typer.Option(help=TO_HELP, metavar="X,Z")] = None,
    record: Record = None,
    scale: Scale = None,
    ground: GroundHeight = None,
    drop: Drop = None,
    passable: Passable = None,
    style: clip_options.Style = PLAIN_NAME,
    swing: clip_options.Swing = None,
    dodge: clip_options.Dodge = None,
    unit: clip_options.Unit = None,
    up: clip_options.Up = None,
    fps: clip_options.Fps = None,
    vmc: vmc_options.Vmc = None,
    vmc_root: vmc_options.VmcRoot = "root",
    vmc_bundles: vmc_options.VmcBundles = True,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Walk an avatar through a scene, faster than real time, and print how it went.

    A scripted user walks forward, along its line through a course, and when stuck backs up and tries again; with --to
    the avatar finds its way to a place. Exit code 0: through, or there, in time, 1: not.
    """
    check_vmc(vmc, vmc_root)
    target = None if to is None else place_of(to, "--to")
    check_arguments(scenes=[scene], planners=[planner], queues=[queue], files=[avatar, bones], written=[record])
    check_arguments(clips=clip_options.named_by(swing, dodge))
    of_place = is_model(scene)
    of_clips = clip_options.told_by(unit, None if of_place else up, fps)
    told = place_options(scale, up if of_place else None, ground, drop, passable)
    reading = settings_by(bones, height, include_hair)
    settings = CrossingSettings(planner, queue, seed, limit)
    from elbowroom.control.recordings.recording import Recorder

    motions = clip_options.motions_by(swing, dodge, of_clips, style)
    place = open_scene(scene, told, quiet)
    controller = chosen_controller(avatar, reading, place, settings, motions, quiet=quiet)
    with (
        progress_bar(said("Walking through {0}", place.title), limit, quiet) as bar,
        nullcontext() if record is None else Recorder(record, controller) as recorder,
        stream_to(vmc, vmc_root, bundles=vmc_bundles) or nullcontext() as stream,
    ):
        outcome = _walked(controller, settings, target or scene, _listener(bar, recorder, stream, controller.humanoid))
    raise typer.Exit(0 if _told(outcome, place.name, record, json) else FELL_SHORT)


def _walked(
    controller: "Controller", settings: CrossingSettings, to: "Place | Spot | str", listener: "Listener"
) -> "Leg | CrossingResult":
    """Walk to a place, or across the scene of this name, as one steers there."""
    from elbowroom.experiment.crossing import run_crossing
    from elbowroom.experiment.gauntlet.scenes import course_user
    from elbowroom.experiment.tour.leg import walk_to

    if isinstance(to, str):
        return run_crossing(controller, settings, listener, course_user(to, settings.seed))
    return walk_to(controller, to, settings.limit, listener)[0]


def _told(outcome: "Leg | CrossingResult", scene: str, record: Path | None, json: bool) -> bool:
    """Print how it went; whether that is what was wanted."""
    from elbowroom.experiment.tour.leg import Leg

    if isinstance(outcome, Leg):
        report_leg(outcome, scene, record, json)
        return outcome.arrived
    _report(outcome, record, json)
    return outcome.passed


def _listener(bar: Bar, recorder: "Recorder | None", stream: "VmcStream | None", humanoid: "Humanoid") -> "Listener":
    """What every step is told to: the recording, a receiver, and now and then the progress bar."""
    count, send = 0, None if stream is None else in_time(stream, humanoid)

    def listen(frame: "Frame", dt: float) -> None:
        nonlocal count
        count += 1
        if recorder is not None:
            recorder.append(frame, dt)
        if send is not None:
            send(frame)
        if count % _FRAMES_PER_UPDATE == 0:
            bar.move(frame.time, f"{frame.time:4.1f} s" + (" stuck" if frame.stuck else ""))

    return listen


def _report(result: "CrossingResult", record: Path | None, json: bool) -> None:
    from dataclasses import asdict

    if json:
        print_json(asdict(result) | {"recording": None if record is None else str(record)})
        return
    yes, punctual = {True: said("yes"), False: said("no")}, result.late_frames == 0
    took = "-" if result.passed_time_s is None else f"{result.passed_time_s:.1f} s"
    rates = said("{0} found, {1} failed", f"{result.plan_success_rate:.1%}", f"{result.plan_failed_rate:.1%}")
    row = {
        "passed": yes[result.passed],
        "straight": yes[result.straight],
        "stuck times": str(result.stuck_times),
        "passed time": took,
        "local planning calls": str(result.plans_total),
        "of these": rates,
        "collision checks": str(result.collision_checks),
        "real time, the paper's": f"{yes[result.realtime]}: {said(_PAPERS[result.realtime])}",
        "real time, ours": said(_LATE, yes[punctual], result.late_frames, result.frames),
        "frame ms, 99 %, worst": f"{result.frame_ms_p99:.2f}, {result.frame_ms_worst:.2f}",
        "least clearance": f"{1e3 * result.least_clearance:.1f} mm",
        "change from plan to plan, 99 %": f"{result.replan_change_p99:.3f} rad",
    }
    if record is not None:
        row["recording"] = str(record)
    title = said(_TITLE, result.scene, result.planner, result.queue_size, result.seed)
    print_row(title, row)
