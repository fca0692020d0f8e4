"""The work that is done apart. A job takes texts and returns records; what it raises is told by `__main__`."""

import contextlib
import json
from collections.abc import Callable
from dataclasses import fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from elbowroom.errors import InputError

if TYPE_CHECKING:  # each job imports what it needs
    from elbowroom.body.humanoid import Humanoid
    from elbowroom.clips.clip import Clip

MAX_CLIPS = 200  # of one file
PLACE = "place"  # the format of a file that is no avatar and no motion, and may be a place


def read_upload(file: str, name: str, glb: str) -> tuple["Humanoid | None", list[str], str]:
    """By content: an avatar, motions, or both: the humanoid, the names of its clips, and their format.

    The avatar's file for a viewer is written to `glb`. The format is `PLACE` for the model of what has no bones.
    Raises `InputError`.
    """
    from elbowroom.body.loading.avatar_file import load_humanoid_bytes
    from elbowroom.clips.files import has_animations, is_motion_only, parse_motion

    data = Path(file).read_bytes()
    if is_motion_only(data, name):
        motions = parse_motion(data, name)
        names = list(motions.clips)[:MAX_CLIPS]
        motions.clip(names[0])  # that it can be shown is found out now
        return None, names, motions.format
    try:
        humanoid = load_humanoid_bytes(data, name)
    except InputError:
        from elbowroom.formats.models.recognised import may_be_a_place

        if may_be_a_place(data, name):
            return None, [], PLACE
        raise
    if humanoid.glb is not None:
        Path(glb).write_bytes(humanoid.glb)
    names, kind = [], ""
    if has_animations(data, name):
        with contextlib.suppress(InputError):
            motions = parse_motion(data, name)
            motions.clip(next(iter(motions.clips)))
            names, kind = list(motions.clips)[:MAX_CLIPS], motions.format
    return replace(humanoid, glb=None), names, kind


def read_place(file: str, name: str, glb: str) -> dict[str, Any]:
    """The scene of a place as `Scene.to_dict` writes it; what a viewer shows is written to `glb`; `InputError`."""
    from elbowroom.world.places.place_scene import place_scene
    from elbowroom.world.places.reading import parse_place
    from elbowroom.world.places.shown import shown_glb

    place = parse_place(Path(file).read_bytes(), name)
    scene = place_scene(place)
    assert scene.place is not None
    Path(glb).write_bytes(shown_glb(place, scene.place.options.ground or 0.0))
    return scene.to_dict()


def read_clip(file: str, name: str, clip: str) -> "Clip":
    """One motion of a file; raises `InputError`."""
    from elbowroom.clips.files import parse_motion

    return parse_motion(Path(file).read_bytes(), name).clip(clip)


def make_course(name: str) -> dict[str, Any]:
    """The scene of a random course as `Scene.to_dict` writes it; raises `InputError`."""
    from elbowroom.experiment.gauntlet.scenes import course_scene

    return course_scene(name).to_dict()


def read_scene(file: str, name: str) -> dict[str, Any]:
    """The scene in a JSON file that a page has sent, as `Scene.to_dict` writes it; raises `InputError`."""
    from elbowroom.world.json_place import parse_json
    from elbowroom.world.scene import Scene

    try:
        text = Path(file).read_text("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"{name}: byte {error.start} is not UTF-8 text; save the file as UTF-8") from None
    document = parse_json(text, name)
    if isinstance(document, dict) and "place" in document:
        raise InputError(f"{name}: $.place names the model of a place; drop the model itself on the page")
    return Scene.from_dict(document, name).to_dict()


def walk_scene(file: str, name: str, humanoid: str) -> tuple[object, ...]:
    """How the humanoid in a file of `answers.packed` fares in such a scene: the fields of an `UnseenWalk`, in order."""
    from elbowroom.experiment.unseen_walk import WalkLimits, walk_unseen
    from elbowroom.server.apart.answers import unpacked
    from elbowroom.world.scene import Scene

    scene = Scene.from_dict(read_scene(file, name), name)
    walk = walk_unseen(unpacked(Path(humanoid).read_bytes()), scene, WalkLimits())
    return tuple(getattr(walk, field.name) for field in fields(walk))


def save_motion(file: str, humanoid: str, glb: str, ending: str, made: str) -> tuple[str, ...]:
    """Write a walk that a page has sent as an animation to `made`; what there is to say about it.

    `humanoid` is a file of `answers.packed`, and `glb` the avatar's own, or "". Raises `InputError`.
    """
    from elbowroom.server.stores import saved_motion

    exported = saved_motion.save_motion(Path(file).read_bytes(), _avatar_in(humanoid, glb), ending)
    Path(made).write_bytes(exported.data)
    return exported.notes


def write_page(file: str, humanoid: str, glb: str, avatar_id: str, made: str) -> tuple[str, ...]:
    """The same for a run, as a page that plays it."""
    from elbowroom.server.standalone.page import page_of_sent
    from elbowroom.server.stores.avatar_store import StoredAvatar

    avatar = StoredAvatar(avatar_id, _avatar_in(humanoid, glb), None)
    page, notes = page_of_sent(Path(file).read_bytes(), avatar)
    Path(made).write_text(page, "utf-8")
    return notes


def _avatar_in(humanoid: str, glb: str) -> "Humanoid":
    from elbowroom.server.apart.answers import unpacked

    found: Humanoid = unpacked(Path(humanoid).read_bytes())
    return replace(found, glb=Path(glb).read_bytes()) if glb else found


def pose_run(file: str, name: str, known: str) -> tuple[object, ...]:
    """The frames of a recording as `run_frames.PosedRun` has them, its fields in order; raises `InputError`.

    `known` tells the avatars of the server: JSON of their references by id.
    """
    from elbowroom.control.recordings.avatar_reference import AvatarReference
    from elbowroom.server.standalone.frames import posed_run

    references = {avatar: AvatarReference(**reference) for avatar, reference in json.loads(known).items()}
    try:
        run = posed_run(Path(file), references)
    except InputError as error:
        raise InputError(str(error).replace(file, name)) from None
    return tuple(getattr(run, field.name) for field in fields(run))


_ALL = (read_upload, read_place, read_scene, walk_scene, read_clip, make_course, pose_run, save_motion, write_page)
JOBS: dict[str, Callable[..., object]] = {job.__name__: job for job in _ALL}
