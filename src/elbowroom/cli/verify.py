"""`elbowroom verify`: the judge looks at what a recording shows."""

from typing import TYPE_CHECKING, Annotated, Any

import typer

from elbowroom.cli.options.answers import Json, Quiet
from elbowroom.cli.options.arguments import check_arguments, check_judge
from elbowroom.cli.options.recording import ItsAvatar, RecordingFile
from elbowroom.cli.telling.first_run import compile_first
from elbowroom.cli.telling.output import print_json, print_row
from elbowroom.cli.telling.spoken import said
from elbowroom.cli.telling.time_left import time_left_bar
from elbowroom.experiment.judge.settings import JudgeSettings

if TYPE_CHECKING:
    from elbowroom.control.recordings.recording import Recording
    from elbowroom.experiment.judge.ledger import Nearness
    from elbowroom.experiment.judge.verdict import BodyVerdict, Verdict

EXAMPLES = "Examples:  elbowroom verify run.elbow  |  elbowroom verify run.elbow --rate 480 --no-mesh --json"
TOUCHES = 1
_ROUNDING = 1e-6
_SHOWN = 12  # contacts in the table; --json has all
_UNITS = {"root": ("m/s", "m/s²", "m/s³")}
_ANGULAR = ("rad/s", "rad/s²", "rad/s³")


def verify(
    recording: RecordingFile,
    *,
    avatar: ItsAvatar = None,
    rate: Annotated[float, typer.Option(help="Poses a second that are judged, at least.")] = 240.0,
    mesh: Annotated[bool, typer.Option(help="Judge the avatar's own surface too, not only its capsules.")] = True,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Check every shown pose against every obstacle with another collision library, coal.

    Exit code 0: nothing touches, 1: something does.
    """
    check_arguments(files=[recording, avatar])
    check_judge()
    settings = JudgeSettings(rate=rate, mesh=mesh)
    from elbowroom.control.recordings.recording import Recording
    from elbowroom.experiment.judge.motion import ShownMotion
    from elbowroom.experiment.judge.verdict import Judging

    recorded = Recording(recording)
    motion, scene = ShownMotion.of(recorded), recorded.scene()
    humanoid = recorded.header.avatar.load(avatar)
    compile_first(quiet=quiet)
    with time_left_bar(said("Judging"), quiet) as move:
        judging = Judging(motion, humanoid, scene, settings)
        for _ in judging.parts():
            move(judging.judged, judging.poses)
    verdict = judging.verdict()
    if json:
        about = {"recording": str(recording), "scene": scene.name, "avatar": humanoid.name, "rate_hz": rate}
        print_json(about | _as_json(verdict) | {"note": recorded.note})
    else:
        _print(recorded, scene.name, verdict)
    raise typer.Exit(0 if verdict.clean else TOUCHES)


def _as_json(verdict: "Verdict") -> dict[str, Any]:
    from dataclasses import asdict

    mesh = None
    if verdict.mesh is not None:
        counts = {"triangles": verdict.triangles, "triangles_left_out": verdict.triangles_left_out}
        mesh = _body_json(verdict.mesh) | counts
    return {
        "clean": verdict.clean,
        "frames_recorded": verdict.frames,
        "frames_checked": verdict.poses,
        "seconds": verdict.seconds,
        "capsules": _body_json(verdict.capsules),
        "self_contact": _body_json(verdict.itself),
        "mesh": mesh,
        "mesh_note": verdict.mesh_note,
        "smoothness": {name: asdict(figures) for name, figures in verdict.smoothness.items()},
    }


def _body_json(body: "BodyVerdict") -> dict[str, Any]:
    return {
        "touching_frames": body.touching,
        "touching_frames_assisted": body.touching_assisted,
        "deepest_mm": 1e3 * body.deepest,
        "least_clearance_mm": None if body.least is None else 1e3 * body.least.clearance,
        "least_clearance_at": None if body.least is None else _moment_json(body.least),
        "tolerance_mm": 1e3 * body.tolerance,
        "contacts": [
            _moment_json(contact.deepest)
            | {
                "depth_mm": -1e3 * contact.deepest.clearance,
                "first_s": contact.first,
                "last_s": contact.last,
                "frames": contact.poses,
            }
            for contact in body.contacts
        ],
    }


def _moment_json(moment: "Nearness") -> dict[str, Any]:
    return {"part": moment.part, "obstacle": moment.obstacle, "time_s": moment.time}


def _print(recorded: "Recording", scene: str, verdict: "Verdict") -> None:
    judged = {
        "verdict": "nothing touches" if verdict.clean else "TOUCHES",
        "frames recorded": f"{verdict.frames}, {verdict.seconds:.1f} s",
        "frames checked": str(verdict.poses),
    }
    capsules = _body_rows("capsules", verdict.capsules)
    no_mesh = {} if verdict.mesh else {"mesh": f"not judged: {verdict.mesh_note}"}
    print_row(f"{recorded.path.name}, scene {scene}", judged | capsules | no_mesh)
    print_row("Body against itself, beyond its natural walk", _self_rows(verdict.itself))
    if verdict.mesh is not None:
        left_out = f", {verdict.triangles_left_out} left out" if verdict.triangles_left_out else ""
        print_row("Skinned mesh", {"triangles": f"{verdict.triangles}{left_out}"} | _body_rows("mesh", verdict.mesh))
    for name, body in (("Capsules", verdict.capsules), ("Mesh", verdict.mesh), ("Own parts", verdict.itself)):
        if body is not None and body.contacts:
            print_row(f"{name} that touch", _contact_rows(body))
    _print_smoothness(verdict)
    if recorded.note is not None:
        print(f"note: {recorded.note}")


def _body_rows(name: str, body: "BodyVerdict") -> dict[str, str]:
    rows = {f"{name} touch in": f"{body.touching} frames (deeper than {1e3 * body.tolerance:g} mm)"}
    if body.touching > body.touching_assisted:
        rows["of these without assistance"] = str(body.touching - body.touching_assisted)
    if body.touching:
        rows["deepest penetration"] = f"{1e3 * body.deepest:.2f} mm"
    if body.least is None:
        return rows | {"least clearance": "no obstacle"}
    where = f"{body.least.part}, {body.least.obstacle}, {body.least.time:.3f} s"
    return rows | {"least clearance": f"{1e3 * body.least.clearance:.2f} mm", "there": where}


def _self_rows(body: "BodyVerdict") -> dict[str, str]:
    rows = {"parts in each other in": f"{body.touching} frames (deeper than {1e3 * body.tolerance:g} mm)"}
    if body.touching:
        rows["deepest"] = f"{1e3 * body.deepest:.2f} mm"
    return rows


def _contact_rows(body: "BodyVerdict") -> dict[str, str]:
    rows = {}
    for contact in body.contacts[:_SHOWN]:
        depth = f"{-1e3 * contact.deepest.clearance:.2f} mm at {contact.deepest.time:.3f} s"
        rows[f"{contact.part}, {contact.obstacle}"] = (
            f"{contact.poses} frames, {contact.first:.3f} to {contact.last:.3f} s, {depth}"
        )
    if len(body.contacts) > _SHOWN:
        rows["and more"] = f"{len(body.contacts) - _SHOWN} (see --json)"
    return rows


def _print_smoothness(verdict: "Verdict") -> None:
    rows = {}
    for name, figures in verdict.smoothness.items():
        extents = zip((figures.speed, figures.acceleration, figures.jerk), _UNITS.get(name, _ANGULAR), strict=True)
        rows[name] = "  ".join(f"{_short(extent.max)} ({_short(extent.p99)}) {unit}" for extent, unit in extents)
    print_row("Speed, acceleration, jerk: largest (99 %)", rows | {"limits of exact": _limits()})


def _limits() -> str:
    """What our own planner keeps to."""
    from elbowroom.body.dof import LOCAL_GROUPS

    return ", ".join(
        f"{group.label} {group.value.speed:g} rad/s {group.value.acceleration:g} rad/s²" for group in LOCAL_GROUPS
    )


def _short(value: float) -> str:
    """Three digits, and no trace of rounding where nothing moves."""
    return f"{value if abs(value) > _ROUNDING else 0.0:.3g}"
