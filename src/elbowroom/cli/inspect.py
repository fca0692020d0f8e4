"""`elbowroom inspect`: what is in the file of an avatar or a place, and what was made of it."""

from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from elbowroom.cli.inspect_place import as_json, draw_plan, look_over, print_place
from elbowroom.cli.options.answers import Json, Quiet
from elbowroom.cli.options.arguments import check_arguments, check_file
from elbowroom.cli.options.place import Drop, GroundHeight, Passable, Scale, UpAxis, place_options
from elbowroom.cli.telling.output import Bar, print_json, print_row, progress_bar
from elbowroom.errors import InputError
from elbowroom.formats.file_bytes import check_ending

if TYPE_CHECKING:
    from elbowroom.body.humanoid import Humanoid
    from elbowroom.body.loading.inspection import AvatarFacts
    from elbowroom.body.loading.settings import LoadSettings
    from elbowroom.world.places.inspection import PlaceFacts
    from elbowroom.world.places.options import PlaceOptions
    from elbowroom.world.places.survey import Survey

EXAMPLES = (
    "Examples:  elbowroom inspect alice.vrm  |  elbowroom inspect knight.glb --bones knight.json --json  |  "
    "elbowroom inspect avatars/ --pose-sheet sheet.png  |  "
    "elbowroom inspect house.glb --drop 'IfcDoor_*' --plan house.png"
)
_SUFFIXES = (".vrm", ".glb", ".gltf", ".x3d", ".x3dv", ".wrl")
_SHOWN = 12  # clips in the table; --json has all


@dataclass
class _Found:
    """What was in the files."""

    avatars: "list[tuple[AvatarFacts, Humanoid]]" = field(default_factory=list)
    places: "list[tuple[PlaceFacts, Survey]]" = field(default_factory=list)
    refused: dict[str, str] = field(default_factory=dict)


def inspect(
    files: Annotated[list[Path], typer.Argument(help="Files of avatars or places, or folders of avatars.")],
    *,
    bones: Annotated[Path | None, typer.Option(help="JSON that names the nodes of bones.")] = None,
    height: Annotated[float | None, typer.Option(help="Metres to the crown, instead of the file's own.")] = None,
    include_hair: Annotated[
        bool, typer.Option("--include-hair", help="Count hair, skirts and the like as the body.")
    ] = False,
    pose_sheet: Annotated[Path | None, typer.Option(help="Draw all in eight gestures into this PNG.")] = None,
    capsules: Annotated[bool, typer.Option("--capsules", help="The sheet shows capsules, not surfaces.")] = False,
    plan: Annotated[Path | None, typer.Option(help="Draw the floors of a place from above into this PNG.")] = None,
    scale: Scale = None,
    up: UpAxis = None,
    ground: GroundHeight = None,
    drop: Drop = None,
    passable: Passable = None,
    kind: Annotated[str | None, typer.Option("--as", help="avatar or place; else the file tells.")] = None,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Say what is in a file. Of an avatar: bones, height, facing, collision body, clips, licence and notes.

    Of a place: size, triangles, floors, how much of each one can walk on, the narrowest passages, what was left out.
    Exit code 0: all files are avatars or places, 2: one is not (the others are shown).
    """
    from elbowroom.body.loading.settings import LoadSettings

    check_arguments(files=[bones], written=[pose_sheet, plan])
    for picture in (pose_sheet, plan):
        check_ending(picture, "a picture", ".png")
    if kind not in (None, "avatar", "place"):
        raise InputError(f"--as {kind!r}: must be avatar or place")
    settings, told = LoadSettings(bones, include_hair, height), place_options(scale, up, ground, drop, passable)
    with progress_bar("Reading", None, quiet) as bar:
        found = _read(_paths(files), kind, settings, told, bar)
    if pose_sheet is not None and found.avatars:
        typer.echo(_draw(pose_sheet, [humanoid for _, humanoid in found.avatars], capsules, quiet), err=json)
    if plan is not None and found.places:
        typer.echo(draw_plan(plan, found.places[0][1]), err=json)
    if json:
        avatars = [asdict(facts) | {"warnings": facts.warnings} for facts, _ in found.avatars]
        places = [as_json(facts) for facts, _ in found.places]
        print_json({"avatars": avatars, "places": places, "refused": found.refused})
    else:
        for facts, _ in found.avatars if pose_sheet is None else ():
            _print(facts)
        for place, _ in found.places:
            print_place(place)
    for message in found.refused.values():
        typer.echo(f"elbowroom: {message}", err=True)
    raise typer.Exit(2 if found.refused else 0)


def _read(paths: list[Path], kind: str | None, settings: "LoadSettings", told: "PlaceOptions", bar: Bar) -> _Found:
    """Read all the files as avatars or places: as told, or else by what they hold."""
    from elbowroom.formats.models.recognised import is_of_a_place, may_be_a_place

    found = _Found()
    for path in paths:
        bar.note(path.name)
        try:
            check_file(path)
            if kind == "place" or (kind is None and is_of_a_place(path)):
                found.places.append(look_over(path, told, bar))
                continue
            from elbowroom.body.loading.inspection import inspect_avatar

            try:
                found.avatars.append(inspect_avatar(path, settings))
            except InputError:
                if kind is not None or not may_be_a_place(path.read_bytes(), path.name):
                    raise
                found.places.append(look_over(path, told, bar))
        except InputError as error:
            found.refused[str(path)] = str(error)
    return found


def _paths(files: list[Path]) -> list[Path]:
    """The files, and those in the folders, however deep."""
    paths: list[Path] = []
    for file in files:
        inside = (
            sorted(path for path in file.rglob("*") if path.suffix.lower() in _SUFFIXES) if file.is_dir() else [file]
        )
        if not inside:
            raise InputError(f"{file}: there is no avatar file in this folder ({', '.join(_SUFFIXES)})")
        paths += inside
    return paths


def _draw(path: Path, humanoids: "list[Humanoid]", capsules: bool, quiet: bool) -> str:
    """Draw the sheet; gives a sentence on it."""
    from PIL import Image

    from elbowroom.experiment.pose_sheet.sheet import pose_sheet

    with progress_bar("Drawing", float(len(humanoids)), quiet) as bar:
        sheet = pose_sheet(humanoids, capsules, lambda row: bar.move(row, humanoids[row - 1].name))
    try:
        Image.fromarray(sheet).save(path, "PNG", optimize=True)
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror or error})") from None
    count = f"{len(humanoids)} avatars" if len(humanoids) > 1 else humanoids[0].name
    return f"{path}: {count} in eight gestures, {sheet.shape[1]} x {sheet.shape[0]} pixels"


def _print(facts: "AvatarFacts") -> None:
    print_row(facts.name, _about(facts))
    print_row("Bones", {bone: f"{source['name']}  ({source['how']})" for bone, source in facts.bones.items()})
    parts = facts.coverage.parts if facts.coverage else {}
    rows = {
        name: f"{100 * radius:.1f} cm" + (f", covers {parts[name]:.1%}" if name in parts else "")
        for name, radius in facts.capsules.items()
    }
    print_row("Collision body", rows)
    if facts.clips:
        rows = {clip.name: f"{clip.seconds:.2f} s" for clip in facts.clips[:_SHOWN]}
        more = {"and more": f"{len(facts.clips) - _SHOWN} (see --json)"} if len(facts.clips) > _SHOWN else {}
        print_row("Clips", rows | more)
    for note in facts.notes:
        print(f"note: {note}")
    for warning in facts.warnings:
        print(f"warning: {warning}")


def _covered(facts: "AvatarFacts") -> str:
    found = facts.coverage
    if found is None:
        return "of average proportions"
    farthest = f"; farthest out {100.0 * found.worst:.1f} cm, at the {found.worst_part}" if found.worst > 0.0 else ""
    return f"{found.share:.1%} of the surface within 1 cm{farthest}"


def _about(facts: "AvatarFacts") -> dict[str, str]:
    said = {
        "title": facts.title,
        "author": ", ".join(facts.authors),
        "contact": facts.contact,
        "licence": facts.licence,
    }
    hows = sorted({str(source["how"]) for source in facts.bones.values()})
    return {
        "format": facts.format,
        **{name: text for name, text in said.items() if text},
        **facts.permissions,
        "height": f"{facts.height:.2f} m to the crown; head joint {facts.head_joint:.2f}, hips {facts.hip_joint:.2f} m",
        "stride": f"{facts.stride:.2f} m at 1.1 m/s",
        "faces": {0: "+Z", 180: "-Z"}.get(round(facts.facing), f"{facts.facing:.0f} degrees from +Z"),
        "rest pose": facts.rest_pose,
        "bones": f"{len(facts.bones)}, found by {', '.join(hows)}",
        "missing, all optional": ", ".join(facts.missing) or "none",
        "capsules": f"{len(facts.capsules)}, {_covered(facts)}",
        "mesh": f"{facts.triangles} triangles, {facts.vertices} vertices of the body",
    }
