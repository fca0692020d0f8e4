"""Collision libraries that a user could take instead, each at its fastest from Python for one posture after another.

They work in double precision and some of them make contacts; ours is single precision and gives distances. What is
compared is the time that a planner in Python waits for the answer to the same question.
"""

from collections.abc import Callable
from importlib.metadata import version
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.experiment.bench.capsule_inputs import CapsuleInputs
from elbowroom.geometry import quaternion

Bools = NDArray[np.bool_]


class Rival(NamedTuple):
    """A library ready to run on the inputs that it was prepared for."""

    name: str
    call: str  # what is timed
    checks: int
    touching: Callable[[], Bools]  # (N,) whether any capsule touches any box


def rivals(inputs: CapsuleInputs) -> tuple[list[Rival], list[str]]:
    """The rivals that are installed, and the names of those that are not."""
    found, missing = [], []
    for name, make in (("mujoco", _mujoco), ("pin", _pinocchio), ("coal", _coal)):
        try:
            found.append(make(inputs))
        except ImportError:
            missing.append(name)
    return found, missing


def _mujoco(inputs: CapsuleInputs) -> Rival:
    import mujoco

    boxes, half = inputs.boxes, 0.5 * inputs.lengths
    geoms = [
        f'<geom type="box" pos="{_text(center)}" quat="{_text(np.roll(turn, 1))}" size="{_text(size)}" '
        'conaffinity="0"/>'
        for center, turn, size in zip(boxes.centers, boxes.rotations, inputs.boxes.half_sizes, strict=True)
    ]
    bodies = [
        f'<body><freejoint/><geom type="capsule" size="{radius} {length}" contype="0" mass="1"/></body>'
        for radius, length in zip(inputs.radii, half, strict=True)
    ]
    model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{''.join(geoms + bodies)}</worldbody></mujoco>")
    data = mujoco.MjData(model)
    middles, turns = inputs.placements()
    states = np.concatenate([middles, np.roll(turns, 1, axis=-1)], axis=-1).reshape(len(middles), -1)

    def touching() -> Bools:
        out = np.empty(len(states), np.bool_)
        for i, state in enumerate(states):
            data.qpos[:] = state
            mujoco.mj_kinematics(model, data)
            mujoco.mj_collision(model, data)
            out[i] = data.ncon > 0
        return out

    return Rival(f"MuJoCo {mujoco.__version__}", "mj_kinematics + mj_collision", inputs.checks, touching)


def _pinocchio(inputs: CapsuleInputs) -> Rival:
    import coal
    import pinocchio as pin

    model, geometry = pin.Model(), pin.GeometryModel()
    arm = []
    for i, (radius, length) in enumerate(zip(inputs.radii, inputs.lengths, strict=True)):
        joint = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), f"joint{i}")
        shape = coal.Capsule(float(radius), float(length))
        arm.append(geometry.addGeometryObject(pin.GeometryObject(f"arm{i}", joint, pin.SE3.Identity(), shape)))
    matrices = quaternion.to_matrix(inputs.boxes.rotations)
    for i, (center, matrix, half) in enumerate(
        zip(inputs.boxes.centers, matrices, inputs.boxes.half_sizes, strict=True)
    ):
        box = pin.GeometryObject(f"box{i}", 0, pin.SE3(matrix, center), coal.Box(*(2.0 * half)))
        number = geometry.addGeometryObject(box)
        for limb in arm:
            geometry.addCollisionPair(pin.CollisionPair(limb, number))
    pool = pin.GeometryPool(model, geometry, 1)
    middles, turns = inputs.placements()
    states = np.ascontiguousarray(np.concatenate([middles, turns], axis=-1).reshape(len(middles), -1).T)

    def touching() -> Bools:
        return np.asarray(pin.computeCollisionsInParallel(1, pool, states, True), np.bool_)

    return Rival(f"Pinocchio {version('pin')}", "computeCollisionsInParallel, 1 thread", inputs.checks, touching)


def coal_capsules(inputs: CapsuleInputs) -> tuple[list[Any], list[list[Any]]]:
    """The capsules (C), and their places in each posture (N lists of C), as coal has them."""
    import coal

    sizes = zip(inputs.radii, inputs.lengths, strict=True)
    capsules = [coal.Capsule(float(radius), float(length)) for radius, length in sizes]
    middles, turns = inputs.placements()
    places = [
        [coal.Transform3s(matrix, middle) for matrix, middle in zip(row, spots, strict=True)]
        for row, spots in zip(quaternion.to_matrix(turns), middles, strict=True)
    ]
    return capsules, places


def _coal(inputs: CapsuleInputs) -> Rival:
    import coal

    matrices = quaternion.to_matrix(inputs.boxes.rotations)
    boxes = [
        (coal.Box(*(2.0 * half)), coal.Transform3s(matrix, center))
        for center, matrix, half in zip(inputs.boxes.centers, matrices, inputs.boxes.half_sizes, strict=True)
    ]
    capsules, places = coal_capsules(inputs)
    # A functor does not keep its shapes alive, so `capsules` and `boxes` stay in the closure.
    functors = [[coal.ComputeCollision(capsule, box) for box, _ in boxes] for capsule in capsules]
    request, result = coal.CollisionRequest(), coal.CollisionResult()

    def touches(row: list[Any]) -> bool:
        hit = False
        for place, against, _ in zip(row, functors, capsules, strict=True):
            for functor, (_, box_place) in zip(against, boxes, strict=True):
                result.clear()
                hit |= functor(place, box_place, request, result) > 0
        return hit

    return Rival(
        f"coal {coal.__version__}",
        "ComputeCollision, every pair",
        inputs.checks,
        lambda: np.array([touches(row) for row in places]),
    )


def _text(values: NDArray[np.float64]) -> str:
    return " ".join(repr(float(value)) for value in values)
