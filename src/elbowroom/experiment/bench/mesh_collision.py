"""How many capsule-mesh checks a second, on one core, beside the libraries that a user could take instead.

Rings with bumps, six of them and as many triangles as asked for, lie where the arm of the other benchmark reaches.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib.metadata import version
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.experiment.bench.capsule_inputs import CapsuleInputs, capsule_inputs
from elbowroom.experiment.bench.collision import Speed, checks_per_second
from elbowroom.experiment.bench.rivals import coal_capsules
from elbowroom.experiment.bench.settings import MeshSettings
from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.meshes.touching import Touching
from elbowroom.world.obstacles.shapes import Mesh

Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]
Longs = NDArray[np.int64]

_RINGS, _RADIUS, _THICKNESS, _BUMP = 6, 0.22, 0.08, 0.05  # metres; the bump in parts of the thickness
_AT_ONCE = 100_000  # postures that are compared with the tree


@dataclass(frozen=True)
class MeshReport:
    """The benchmark's figures."""

    triangles: int
    own: Speed
    rivals: tuple[Speed, ...]
    missing: tuple[str, ...]
    checks: int  # that were made by the whole and by the tree of triangles alone
    touching_share: float
    false_free: int  # of these: free by the whole, touching by the tree
    false_touching: int


def run(settings: MeshSettings, tick: Callable[[int], None] = lambda _: None) -> MeshReport:
    """Time all in turns, round by round; then hold every answer against the tree of triangles."""
    inputs = capsule_inputs(settings.postures, _RINGS, settings.seed)
    mesh = bumpy_rings(inputs, settings.triangles, settings.seed)
    field, segments = Touching(mesh), _about(inputs, mesh)
    few, timed = inputs.first(min(settings.rival_postures, settings.postures)), segments[:, :, :10_000].copy()
    rivals, missing = _rivals(few, mesh)
    call = partial(field.touches_about_middle, timed, inputs.radii)
    ours, theirs = call()[:, : few.segments.shape[2]], [answer() for _, _, answer in rivals]
    own_rates: list[float] = []
    rates: list[list[float]] = [[] for _ in rivals]
    for number in range(settings.rounds):
        own_rates.append(checks_per_second(timed.shape[0] * timed.shape[2], call))
        for own, (_, _, answer) in zip(rates, rivals, strict=True):
            own.append(checks_per_second(ours.size, answer, calls=1))
        tick(number + 1)
    touching, false_free, false_touching = _against_the_tree(field, segments, inputs)
    return MeshReport(
        triangles=len(mesh.faces),
        own=Speed("Elbowroom", "Touching", float(np.median(own_rates))),
        rivals=tuple(
            Speed(name, said, float(np.median(own)), int((answer != ours.any(axis=0)).sum()), _ratio(own_rates, own))
            for (name, said, _), own, answer in zip(rivals, rates, theirs, strict=True)
        ),
        missing=tuple(missing),
        checks=segments.shape[0] * segments.shape[2],
        touching_share=touching,
        false_free=false_free,
        false_touching=false_touching,
    )


def _ratio(ours: list[float], theirs: list[float]) -> float:
    return float(np.median(np.array(ours) / np.array(theirs)))


def _about(inputs: CapsuleInputs, mesh: Mesh) -> NDArray[np.float32]:
    axes: NDArray[np.float32] = (inputs.segments - np.tile(mesh.middle, 2)[:, None]).astype(np.float32)
    return axes


def _against_the_tree(field: Touching, segments: NDArray[np.float32], inputs: CapsuleInputs) -> tuple[float, int, int]:
    """The share that touches, and the answers that differ from those of the triangles: falsely free, falsely not."""
    touching = free = taken = 0
    for start in range(0, segments.shape[2], _AT_ONCE):
        part = np.ascontiguousarray(segments[:, :, start : start + _AT_ONCE])
        ours, exact = field.touches_about_middle(part, inputs.radii), field.touches_a_triangle(part, inputs.radii)
        touching, free, taken = touching + exact.sum(), free + (exact & ~ours).sum(), taken + (ours & ~exact).sum()
    return float(touching) / (segments.shape[0] * segments.shape[2]), int(free), int(taken)


def bumpy_rings(inputs: CapsuleInputs, triangles: int, seed: int) -> Mesh:
    """Rings in the places of the boxes, of about so many triangles together."""
    rng, boxes = np.random.default_rng(seed), inputs.boxes
    long = int(np.sqrt(0.5 * triangles / _RINGS * _RADIUS / _THICKNESS))
    wide = int(0.5 * triangles / _RINGS / long)
    vertices, faces = [], []
    for number, (center, turn) in enumerate(zip(boxes.centers, boxes.rotations, strict=True)):
        around, across = np.meshgrid(*(2.0 * np.pi * np.arange(n) / n for n in (long, wide)), indexing="ij")
        bumps = 1.0 + 0.15 * np.sin(5.0 * around + 3.0 * across) + _BUMP * rng.normal(size=around.shape)
        away = _RADIUS + _THICKNESS * bumps * np.cos(across)
        points = np.stack([away * np.cos(around), away * np.sin(around), _THICKNESS * bumps * np.sin(across)], axis=-1)
        vertices.append(quaternion.rotate(turn, points.reshape(-1, 3)) + center)
        faces.append(_grid_faces(long, wide) + number * long * wide)
    return Mesh(np.concatenate(vertices), np.concatenate(faces))


def _grid_faces(long: int, wide: int) -> Longs:
    """Two triangles for each cell of a grid that is closed both ways."""
    a = np.arange(long * wide).reshape(long, wide)
    b, d = np.roll(a, -1, axis=0), np.roll(a, -1, axis=1)
    c = np.roll(b, -1, axis=1)
    return np.concatenate([np.stack(three, axis=-1).reshape(-1, 3) for three in ((a, b, c), (a, c, d))])


def _rivals(inputs: CapsuleInputs, mesh: Mesh) -> tuple[list[tuple[str, str, Callable[[], Bools]]], list[str]]:
    """Name, call, and whether any capsule of each posture touches (N,); and who is not installed."""
    found, missing = [], []
    for name, make in (("pin", _pinocchio), ("coal", _coal)):
        try:
            found.append(make(inputs, mesh))
        except ImportError:
            missing.append(name)
    return found, missing


def _tree(mesh: Mesh) -> Any:
    import coal

    tree, points, faces = coal.BVHModelOBBRSS(), coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    for corner in mesh.vertices:
        points.append(corner)
    for a, b, c in mesh.faces.tolist():
        faces.append(coal.Triangle(a, b, c))
    tree.beginModel(len(mesh.faces), len(mesh.vertices))
    tree.addSubModel(points, faces)
    tree.endModel()
    return tree


def _pinocchio(inputs: CapsuleInputs, mesh: Mesh) -> tuple[str, str, Callable[[], Bools]]:
    import coal
    import pinocchio as pin

    model, geometry, arm = pin.Model(), pin.GeometryModel(), []
    for i, (radius, length) in enumerate(zip(inputs.radii, inputs.lengths, strict=True)):
        joint = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), f"joint{i}")
        shape = coal.Capsule(float(radius), float(length))
        arm.append(geometry.addGeometryObject(pin.GeometryObject(f"arm{i}", joint, pin.SE3.Identity(), shape)))
    number = geometry.addGeometryObject(pin.GeometryObject("mesh", 0, pin.SE3.Identity(), _tree(mesh)))
    for limb in arm:
        geometry.addCollisionPair(pin.CollisionPair(limb, number))
    pool = pin.GeometryPool(model, geometry, 1)
    middles, turns = inputs.placements()
    states = np.ascontiguousarray(np.concatenate([middles, turns], axis=-1).reshape(len(middles), -1).T)

    def touching() -> Bools:
        return np.asarray(pin.computeCollisionsInParallel(1, pool, states, True), np.bool_)

    return f"Pinocchio {version('pin')}", "computeCollisionsInParallel, 1 thread", touching


def _coal(inputs: CapsuleInputs, mesh: Mesh) -> tuple[str, str, Callable[[], Bools]]:
    import coal

    tree, still = _tree(mesh), coal.Transform3s.Identity()
    capsules, places = coal_capsules(inputs)
    # A functor does not keep its shapes alive, so they stay beside it.
    functors = [(coal.ComputeCollision(capsule, tree), capsule, tree) for capsule in capsules]
    request, result = coal.CollisionRequest(), coal.CollisionResult()

    def touches(row: list[Any]) -> bool:
        hit = False
        for place, (functor, _, _) in zip(row, functors, strict=True):
            result.clear()
            hit |= functor(place, still, request, result) > 0
        return hit

    return f"coal {coal.__version__}", "ComputeCollision", lambda: np.array([touches(row) for row in places])
