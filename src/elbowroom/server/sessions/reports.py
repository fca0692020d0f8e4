"""What a session tells its client, made from what it knows. No state."""

import math
from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import AvatarMeta
from elbowroom.body.root import HEIGHT
from elbowroom.control.frame import Frame, PlanReport
from elbowroom.control.shown.body_check import configuration
from elbowroom.control.things.loose import pushable
from elbowroom.planning.result import BlockadeKind
from elbowroom.server.schema.bounds import Reason
from elbowroom.server.schema.picture import (
    AvatarCapsule,
    AvatarMessage,
    Bone,
    ClipMessage,
    Form,
    Gate,
    Ground,
    Model,
    MovingObstacle,
    Obstacle,
    Place,
    SceneMessage,
    Stop,
)
from elbowroom.server.schema.progress import Blocked, GroupReport, Plan
from elbowroom.server.stores.avatar_store import StoredAvatar
from elbowroom.server.stores.clip_store import StoredClip
from elbowroom.server.wire.pose import placement
from elbowroom.world.obstacles.meshes.hulls import surface_of
from elbowroom.world.obstacles.shapes import Box, Capsule, Cylinder, Hull, Mesh, Shape, Sphere, extents_of
from elbowroom.world.obstacles.tracks.moving import Track
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

_MOST_FACTS = 20
_SHAPES: dict[type[Shape], Literal["box", "sphere", "capsule", "cylinder", "hull", "mesh"]] = {
    Box: "box",
    Sphere: "sphere",
    Capsule: "capsule",
    Cylinder: "cylinder",
    Hull: "hull",
    Mesh: "mesh",
}
_REASONS: dict[BlockadeKind, Reason] = {
    BlockadeKind.NO_POSTURE: "noPosture",
    BlockadeKind.OUT_OF_REACH: "outOfReach",
    BlockadeKind.MOTION: "motion",
}


def scene_message(scene: Scene) -> SceneMessage:
    """The scene as a client draws it: what a model shows of it is not told as obstacles too."""
    model = model_of(scene)
    shown = scene.place.parts if model and scene.place else 0
    return SceneMessage(
        name=scene.name,
        title=scene.title,
        description=scene.description,
        ground=Ground(scene.ground_center, scene.ground_size),
        model=model,
        pushable=list(pushable(scene)),
        obstacles=[_obstacle(scene, *obstacle) for obstacle in list(scene.obstacles)[shown:]],
        moving=[_moving(scene, track) for track in scene.obstacles.moving.tracks],
        start=Place(scene.start.x, scene.start.z, scene.start.heading),
        finish=Gate(*scene.finish.position, scene.finish.heading, scene.finish.width),
        tour=[Stop(stop.position, stop.height, stop.view, stop.say, stop.seconds) for stop in scene.tour],
    )


def model_of(scene: Scene) -> Model | None:
    """The model that a client fetches and shows; none where the scene has no file for it."""
    place = scene.place
    return Model(f"places/{place.glb.stem}.glb", place.file) if place and place.glb else None


def _obstacle(scene: Scene, name: str, shape: Shape, center: Floats, turn: Floats) -> Obstacle:
    return Obstacle(name, _form(shape), tuple(center.tolist()), tuple(turn.tolist()), scene.colors.get(name, ""))


def _moving(scene: Scene, track: Track) -> MovingObstacle:
    centers = [(a, b, c) for a, b, c in track.centers.tolist()]
    return MovingObstacle(
        name=track.name,
        form=_form(track.shape),
        times=track.times.tolist(),
        centers=centers,
        yaws=track.yaws.tolist(),
        repeat=track.repeat.value,
        color=scene.colors.get(track.name, ""),
    )


def _form(shape: Shape) -> Form:
    corners, triangles = _surface(shape)
    return Form(
        _SHAPES[type(shape)],
        tuple((2.0 * extents_of(shape)).tolist()),
        [(x, y, z) for x, y, z in corners.tolist()],
        [(int(a), int(b), int(c)) for a, b, c in triangles.tolist()],
    )


def _surface(shape: Shape) -> tuple[Floats, NDArray[np.int64]]:
    """Corners (V, 3) and triangles (T, 3) of what is drawn by them."""
    match shape:
        case Hull():
            return surface_of(shape)
        case Mesh(vertices, faces):
            return vertices, faces
        case _:
            return np.empty((0, 3)), np.empty((0, 3), np.int64)


def avatar_message(avatar: StoredAvatar, revision: int) -> AvatarMessage:
    """The avatar as a client draws and poses it."""
    humanoid = avatar.humanoid
    skeleton, capsules, rig = humanoid.skeleton, humanoid.capsules, humanoid.rig
    shown = rig is not None and avatar.glb is not None
    nodes = rig.nodes.tolist() if rig is not None else [-1] * len(skeleton.names)
    return AvatarMessage(
        id=avatar.id,
        revision=revision,
        title=avatar.title,
        authors=list(humanoid.meta.authors),
        licence=humanoid.meta.licence,
        facts=_facts(humanoid.meta),
        format=humanoid.meta.format,
        url=f"avatars/{avatar.id}.glb" if shown else None,
        draw_capsules=not shown or not humanoid.meta.has_body,
        bones=[Bone(name, node) for name, node in zip(skeleton.names, nodes, strict=True)],
        placement=placement(rig),
        capsules=[
            AvatarCapsule(name, radius, group.label)
            for name, radius, group in zip(capsules.names, capsules.radii.tolist(), capsules.groups, strict=True)
        ],
        height=skeleton.height,
    )


def _facts(meta: AvatarMeta) -> list[str]:
    permissions = [f"{name}: {said}" for name, said in meta.permissions.lines().items()]
    return [*permissions, *meta.notes][:_MOST_FACTS]


def clip_message(stored: StoredClip) -> ClipMessage:
    """The clip that is played, and what was recognised in it."""
    clip, planning = stored.clip, stored.clip.planning
    return ClipMessage(
        id=stored.id,
        title=stored.title,
        format=clip.format,
        up=clip.figure.up,
        unit=clip.figure.unit_name,
        metres=clip.figure.unit,
        fps=clip.fps,
        frames=clip.frames,
        seconds=clip.motion.duration,
        speed=planning.track.strides.speed,
        trunk_degrees=float(np.rad2deg(planning.trunk_error.mean())),
        arm_degrees=float(np.rad2deg(planning.arm_error.mean())),
    )


def group_reports(plan: PlanReport | None) -> list[GroupReport]:
    """What each group's search in the last plan cost."""
    evidence = () if plan is None else plan.local.evidence
    return [
        GroupReport(e.group.label, e.status.value, e.checks, e.nodes, e.enhanced, e.nanoseconds / 1e6) for e in evidence
    ]


def blocked_message(plan: PlanReport | None, known: Sequence[str]) -> Blocked | None:
    """Why the last plan is not the whole way that was asked for; obstacles are `known` by these names."""
    blockade = None if plan is None else plan.local.blockade
    if blockade is None:
        return None
    names = list(dict.fromkeys(known[number] for number in blockade.obstacles if number < len(known)))
    return Blocked(_REASONS[blockade.kind], names, round(blockade.ahead, 3), blockade.place)


def plan_message(frame: Frame, avatar: StoredAvatar) -> Plan:
    """The key frames that wait, and the wanted beside the chosen posture."""
    keys, root = frame.key_frames, frame.root
    waiting = [configuration(*key) for key in zip(keys.roots, keys.uppers, strict=True)]
    shown = np.array([configuration(root, frame.goal), frame.q])
    segments = avatar.poser.segments(shown, np.array([root, root]))
    if waiting:
        segments = np.concatenate([avatar.poser.segments(np.array(waiting), keys.roots), segments])
    rows = np.round(segments.reshape(len(segments), -1).astype(np.float64), 4).tolist()
    return Plan(
        times=keys.times.tolist(),
        root=[tuple(state) for state in np.round(keys.roots[:, :3], 4).tolist()],
        ghosts=rows[:-2],
        goal=rows[-2],
        chosen=rows[-1],
        heights=np.round(keys.roots[:, HEIGHT], 4).tolist(),
    )


def finite(value: float) -> float | None:
    """`value` for JSON, which has no infinity."""
    return value if math.isfinite(value) else None
