"""`elbowroom export`: what a recording shows, or a scene alone, for other programs."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from elbowroom.cli.options.answers import Json, Quiet
from elbowroom.cli.options.arguments import check_arguments
from elbowroom.cli.options.recording import HOW_MADE, ItsAvatar
from elbowroom.cli.telling.first_run import compile_first
from elbowroom.cli.telling.output import print_json, print_row, progress_bar
from elbowroom.cli.telling.spoken import said
from elbowroom.errors import InputError
from elbowroom.export.formats import Wishes, check_rate, format_of

if TYPE_CHECKING:
    from elbowroom.control.recordings.recording import Recording
    from elbowroom.export.animation import Animation

EXAMPLES = (
    "Examples:  elbowroom export run.elbow -o walk.bvh  |  elbowroom export run.elbow -o walk.bvh --fps 30 --up z"
)

_SCENES = {".glb": "GLB", ".x3d": "X3D"}  # what a scene alone is written as


def export(
    recording: Annotated[Path | None, typer.Argument(help=HOW_MADE)] = None,
    *,
    scene: Annotated[str | None, typer.Option(help="A scene in place of a recording: .glb or .x3d.")] = None,
    out: Annotated[Path, typer.Option("--out", "-o", help="The file to write; its ending says the format.")],
    fps: Annotated[float, typer.Option(help="Frames a second.")] = 60.0,
    root: Annotated[str, typer.Option(help="What carries the way: hips, root (a node above them) or none.")] = "hips",
    rest: Annotated[str | None, typer.Option(help="Rest pose: t, or a with the arms lowered.")] = None,
    unit: Annotated[str | None, typer.Option(help="m, dm, cm, mm, inch, foot, or metres as a number.")] = None,
    up: Annotated[str | None, typer.Option(help="The axis that points up: y or z.")] = None,
    avatar: ItsAvatar = None,
    place: Annotated[bool, typer.Option("--place", help="GLB: put the scene beside the avatar.")] = False,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace the file if it exists.")] = False,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Write the motion of a recording as a file that other programs read: .bvh, .glb, .vrma,
    .x3d, .usda, .csv or .npz; or as a page that plays by itself: .html.

    It holds the frames as the page shows them. BVH is in centimetres with Y up and a T-pose, unless told otherwise.
    GLB has the avatar's mesh in it where its licence allows that.
    """
    check_arguments(scenes=[] if scene is None else [scene], files=[recording, avatar], written=[out])
    if out.exists() and not overwrite:
        raise InputError(f"{out}: exists; choose another name or say --overwrite")
    if scene is not None or recording is None:
        _export_scene(scene, recording, out, json=json)
        return
    if out.suffix.lower() in (".html", ".htm"):
        _export_page(recording, out, avatar, json=json, quiet=quiet)
        return
    chosen = format_of(out)
    layout = chosen.layout(Wishes(root, rest, unit, up))
    check_rate(fps)
    if place and chosen.title != "GLB":
        raise InputError(f"{out}: --place is possible in .glb only")
    from elbowroom.control.recordings.recording import Recording
    from elbowroom.export.animation import Animation
    from elbowroom.export.writers import WRITERS

    recorded = Recording(recording)
    humanoid = recorded.header.avatar.load(avatar)
    compile_first(quiet=quiet)
    with progress_bar(said("Writing {0}", out.name), None, quiet):
        animation = Animation.of(recorded, humanoid, fps)
        written = WRITERS[chosen.ending](animation, humanoid, layout)
        if place:
            written = replace(written, data=_with_place(written.data, recorded, animation))
        _keep(out, written.data)
    notes = [*written.notes, *([f"not whole: {recorded.note}"] if recorded.note else [])]
    _report(out, chosen.title, len(written.data), animation, notes, json)


def _export_page(recording: Path, out: Path, avatar: Path | None, *, json: bool, quiet: bool) -> None:
    from elbowroom.control.recordings.recording import Recording
    from elbowroom.server.standalone.page import page_of_recording

    recorded = Recording(recording)
    humanoid = recorded.header.avatar.load(avatar)
    compile_first(quiet=quiet)
    with progress_bar(said("Writing {0}", out.name), None, quiet):
        page, notes = page_of_recording(recorded, humanoid, recording.name)
        _keep(out, data := page.encode())
    notes = (*notes, *([f"not whole: {recorded.note}"] if recorded.note else []))
    if json:
        print_json({"file": str(out), "format": "HTML", "bytes": len(data), "notes": list(notes)})
    else:
        print_row(str(out), {"format": "HTML", "size": f"{len(data) / 1e3:.1f} kB"})
        for note in notes:
            print(note)


def _export_scene(name: str | None, recording: Path | None, out: Path, *, json: bool) -> None:
    if name is None or recording is not None:
        raise InputError("export: give either a recording or --scene, such as `elbowroom export --scene d -o d.glb`")
    if out.suffix.lower() not in _SCENES:
        raise InputError(f"{out}: a scene is written as .glb or .x3d")
    from elbowroom.experiment.gauntlet.scenes import load_scene
    from elbowroom.export.place import place_glb
    from elbowroom.export.place_x3d import place_x3d

    title = _SCENES[out.suffix.lower()]
    write = place_glb if title == "GLB" else place_x3d
    scene = load_scene(name)
    data = write(scene)
    _keep(out, data)
    things = len(list(scene.obstacles)) + len(scene.obstacles.moving)
    if json:
        print_json({"file": str(out), "format": title, "bytes": len(data), "obstacles": things})
    else:
        print_row(str(out), {"format": title, "size": f"{len(data) / 1e3:.1f} kB", "obstacles": str(things)})


def _with_place(glb: bytes, recorded: "Recording", animation: "Animation") -> bytes:
    from elbowroom.export.place import with_place

    return with_place(glb, recorded.scene(), animation)


def _keep(path: Path, data: bytes) -> None:
    try:
        path.write_bytes(data)
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror})") from None


def _report(out: Path, title: str, size: int, animation: "Animation", notes: list[str], json: bool) -> None:
    facts: dict[str, Any] = {
        "file": str(out),
        "format": title,
        "bytes": size,
        "frames": len(animation),
        "fps": animation.fps,
        "joints": len(animation.skeleton.names),
        "notes": notes,
    }
    if json:
        print_json(facts)
        return
    seconds = (len(animation) - 1) / animation.fps
    row = {
        "format": title,
        "size": f"{size / 1e3:.1f} kB",
        "frames": said("{0} at {1} a second, {2} s", len(animation), f"{animation.fps:g}", f"{seconds:.1f}"),
        "joints": str(facts["joints"]),
    }
    print_row(str(out), row)
    for note in notes:
        print(said("note: {0}", note))
