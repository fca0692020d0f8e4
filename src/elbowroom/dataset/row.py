"""The row of a walk: what was shown, as plain arrays."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, posture_capsules
from elbowroom.body.root import HEIGHT, ROOT_STATE, TOLD_FEET, RootState, told
from elbowroom.body.skeleton import Skeleton
from elbowroom.control.frame import Frame
from elbowroom.dataset.draw import DrawnWalk
from elbowroom.experiment.crossing import DT
from elbowroom.export.animation import Animation, posed_frames
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene

if TYPE_CHECKING:
    from elbowroom.dataset.company import Company

Floats = NDArray[np.float64]
Row = dict[str, Any]  # by the names of the columns: numbers, texts, arrays with a row for each frame, lists

_NEAR = 3.0  # metres
_GEOMETRY = ("parts", "data", "floor")  # of a place in a scene's document


def row_of(
    number: int, drawn: DrawnWalk, fps: int, humanoid: Humanoid, scene: Scene, steps: Sequence[tuple[Command, Frame]]
) -> Row:
    """The row of walk `number`, every so many of its frames, 60 a second, that `fps` a second are left."""
    from elbowroom.dataset.columns import SMPL_BONES

    kept = steps[:: _every(fps)]
    frames = [frame for _, frame in kept]
    q, roots = np.stack([frame.q for frame in frames]), np.stack([frame.root for frame in frames])
    times = np.array([frame.time for frame in frames])
    behind = told(roots)[:, ROOT_STATE:]
    rotations, joints, known = _posed(humanoid, q, roots, fps)
    present = np.array([humanoid.skeleton.has(bone) for bone in SMPL_BONES])
    local = np.where(present[:, None], rotations[:, known], [0.0, 0.0, 0.0, 1.0])
    return {
        "walk": number,
        "place": _named(drawn.place),
        "avatar": _named(drawn.avatar),
        "swing": _named(drawn.swing),
        "steering": drawn.steering,
        "seed": drawn.seed,
        "fps": fps,
        "frames": len(frames),
        "reached": scene.finished(RootState.of(steps[-1][1].root)),
        "stuck_frames": sum(frame.stuck for _, frame in steps),
        "scene": json.dumps(_document(scene), separators=(",", ":"), sort_keys=True),
        "obstacles": list(scene.obstacles.names),
        "time": times,
        "command": np.array([_wish(command) for command, _ in kept]),
        "root": roots[:, :HEIGHT],
        "height": roots[:, HEIGHT],
        "feet": behind[:, :TOLD_FEET],
        "carriage": behind[:, TOLD_FEET:],
        "q": q,
        "joints": joints,
        "rotations": local.reshape(len(frames), -1),
        "contacts": np.stack([frame.contacts for frame in frames]),
        "clearance": np.array([frame.clearance for frame in frames]),
        "nearest": _nearest(humanoid, scene, q, roots, times),
        "near": [_near(scene, root) for root in roots],
    }


def others_in(company: "Company", names: Sequence[str], fps: int) -> Row:
    """The columns of those who walk there too, of as many frames as the walk has."""
    seen = [one.frames[:: _every(fps)] for one in company.companions]
    poses = [(np.stack([frame.q for frame in own]), np.stack([frame.root for frame in own])) for own in seen]
    joints = [_posed(one.humanoid, q, roots, fps)[1] for one, (q, roots) in zip(company.companions, poses, strict=True)]
    return {
        "others": [_named(name) for name in names],
        "others_root": [roots[:, : HEIGHT + 1].astype(np.float32).ravel().tolist() for _, roots in poses],
        "others_joints": [places.astype(np.float32).ravel().tolist() for places in joints],
    }


def _every(fps: int) -> int:
    """Of so many of the frames, 60 a second, one is kept."""
    return round(1.0 / (DT * fps))


def _posed(humanoid: Humanoid, q: Floats, roots: Floats, fps: int) -> tuple[Floats, Floats, list[int]]:
    """Local rotations (F, J, 4), places (F, 66) of the SMPL joints in the world, and which joints these are."""
    from elbowroom.dataset.columns import SMPL_BONES

    rotations, hips = posed_frames(humanoid, q, roots)
    body = Animation("", fps, humanoid.skeleton, rotations, hips, roots[:, [0, HEIGHT, 1]], roots[:, 2])
    known = [_present(humanoid.skeleton, bone) for bone in SMPL_BONES]
    return rotations, body.joints_in_world()[:, known].reshape(len(q), -1), known


def _document(scene: Scene) -> dict[str, Any]:
    """The scene's JSON; a model of a place is named by its file and sum, and not copied."""
    document = scene.to_dict()
    if "place" in document:
        document["place"] = {name: told for name, told in document["place"].items() if name not in _GEOMETRY}
    return document


def _wish(command: Command) -> tuple[float, float, float, float]:
    direction = np.nan if command.direction is None else command.direction
    return command.forward, command.strafe, command.turn, direction


def _nearest(humanoid: Humanoid, scene: Scene, q: Floats, roots: Floats, times: Floats) -> NDArray[np.int32]:
    capsules = posture_capsules(body_model(humanoid), q, roots)
    found = np.full(len(q), -1, np.int32)
    for n, (root, time) in enumerate(zip(roots, times.tolist(), strict=True)):
        own = capsules[:, :, n].astype(np.float64) - np.tile([root[0], 0.0, root[1]], 2)
        nearest = scene.obstacles.nearest_pair(own, humanoid.capsules.radii, root[:2], time)
        found[n] = -1 if nearest is None else nearest.obstacle
    return found


def _near(scene: Scene, root: Floats) -> list[int]:
    standing = scene.obstacles.numbers_near(root[:2] - _NEAR, root[:2] + _NEAR).tolist()
    names = len(scene.obstacles.names)
    return [*standing, *range(names - len(scene.obstacles.moving), names)]


def _present(skeleton: Skeleton, bone: str) -> int:
    """The joint of a bone, or of the nearest one above it that the avatar has."""
    from elbowroom.body.bones import PARENTS

    name: str | None = bone
    while name is not None and not skeleton.has(name):
        name = PARENTS[name]
    return skeleton.index(name or "hips")


def _named(name: str) -> str:
    """A file's name without its folder: rows tell nothing of a machine."""
    return Path(name).name if "." in name else name
