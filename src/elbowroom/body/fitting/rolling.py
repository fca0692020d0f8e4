"""How an avatar's own feet roll over the ground, measured on their surface.

A pitched foot touches the ground with the edge of its sole or, where that is round, with what is higher up and farther
out. Its toes, if they bend, stay level under it, and a surface that hangs on both is drawn into the ground between
them. So for a foot at each pitch the ankle is looked for at which the lowest point is on the ground, and that is moved
from pitch to pitch as no point slips on which the foot stands: one of the toes, where these are on the ground.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.capsules import Capsules
from elbowroom.body.fitting.body_mesh import BodyMesh
from elbowroom.body.fitting.body_parts import SIDES
from elbowroom.body.fitting.surface import used_vertices
from elbowroom.body.skeleton import Skeleton
from elbowroom.body.soles import PITCHES, Soles

Floats = NDArray[np.float64]

_STRIKE, _TOE_OFF = 0.3, 1.0  # radians that a foot is pitched in a stride, toes up and toes down
_ON_GROUND = 0.004  # metres: what is no higher than that over the lowest point carries the foot too
_FINER = 5  # steps from each of `PITCHES` to the next
_FARTHEST = 1.2  # of the leg: what is farther before or behind the ankle is no foot
_NO_HEEL = 0.08  # of the leg, behind the ankle, where no mesh shows it


class _Foot(NamedTuple):
    """Points of one foot in T-pose, seen from the ankle over the ground; (P, 2) are metres up and ahead."""

    by_foot: Floats  # (P, 2) times the part that the foot carries
    by_toes: Floats  # (P, 2) the same from the joint of the toes
    toes: Floats  # (P,) the part that toes carry
    joint: Floats  # (2,) where the joint of the toes is

    def pitched(self, pitch: float) -> Floats:
        """Where the points (P, 2) are when the ankle keeps its place, and toes stay level as the heel rises."""
        foot, toes = _turn(pitch), _turn(min(pitch, 0.0))
        placed: Floats = self.by_foot @ foot + self.by_toes @ toes + self.toes[:, None] * (self.joint @ foot)
        return placed


def soles_of(skeleton: Skeleton, capsules: Capsules, body: BodyMesh | None) -> Soles:
    """The soles of a body in T-pose, in the skeleton's frame; those of its `capsules` where a foot has no mesh."""
    found = [None if body is None else _of_mesh(skeleton, body, side) for side in SIDES]
    feet = [foot or _of_capsule(skeleton, capsules, side) for foot, side in zip(found, SIDES, strict=True)]
    flat = [foot.pitched(0.0) + np.array([ankle, 0.0]) for foot, ankle in zip(feet, _ankles(skeleton), strict=True)]
    return Soles(
        heels=np.array([_edge(-at[:, 1], at[:, 0], _STRIKE) for at in flat]),
        tips=np.array([_edge(at[:, 1], at[:, 0], _TOE_OFF) for at in flat]),
        rolls=np.array([_rolled(foot) for foot in feet]),
    )


def _ankles(skeleton: Skeleton) -> list[float]:
    """How high both ankles are, metres."""
    return [float(skeleton.positions[skeleton.index(f"{side}Foot"), 1]) for side in SIDES]


def _turn(pitch: float) -> Floats:
    """What turns rows (y, z) by a pitch, toes down."""
    sine, cosine = np.sin(pitch), np.cos(pitch)
    return np.array([[cosine, sine], [-sine, cosine]])


def _edge(out: Floats, up: Floats, pitch: float) -> float:
    """How far out a foot turns about that is pitched so much, given how far its points (P,) are out, and above ground.

    It does so about a place on the ground, and none of its points gets below that.
    """
    return float((out - up / np.tan(pitch)).max())


def _toes(skeleton: Skeleton, side: str) -> int | None:
    return skeleton.index(f"{side}Toes") if skeleton.has(f"{side}Toes") else None


def _of_mesh(skeleton: Skeleton, body: BodyMesh, side: str) -> _Foot | None:
    """Its vertices below the ankle, but not those of skis; None without any."""
    foot, toes = skeleton.index(f"{side}Foot"), _toes(skeleton, side)
    ankle, joint = skeleton.positions[foot], skeleton.positions[foot if toes is None else toes]
    used = used_vertices(body)
    mine = used[np.isin(body.joints[used, 0], [foot] if toes is None else [foot, toes])]
    low, out = body.places[mine, 0, 1], np.abs(body.places[mine, 0, 2] - ankle[2])
    mine = mine[(low <= max(ankle[1], joint[1])) & (out <= _FARTHEST * _leg(skeleton, side))]
    if not len(mine):
        return None
    bent = body.joints[mine] == toes if toes is not None else np.zeros(body.joints[mine].shape, np.bool_)
    by_foot, by_toes = np.where(bent, 0.0, body.weights[mine]), np.where(bent, body.weights[mine], 0.0)
    places = body.places[mine]
    return _Foot(
        np.einsum("vk,vki->vi", by_foot, places - ankle)[:, 1:],
        np.einsum("vk,vki->vi", by_toes, places - joint)[:, 1:],
        by_toes.sum(axis=1),
        (joint - ankle)[1:],
    )


def _of_capsule(skeleton: Skeleton, capsules: Capsules, side: str) -> _Foot:
    """Heel, ball and tip of the toes, by the bones and the foot's capsule."""
    foot, toes, at = skeleton.index(f"{side}Foot"), _toes(skeleton, side), capsules.names.index(f"{side}Foot")
    ankle, joint = skeleton.positions[foot], skeleton.positions[foot if toes is None else toes]
    tip = max(float(capsules.starts[at, 2]), float(capsules.ends[at, 2])) + float(capsules.radii[at])
    ball, bends = float(joint[2] - ankle[2]), np.array([0.0, 0.0, 0.0 if toes is None else 1.0])
    by_foot = np.array([[-ankle[1], -_NO_HEEL * _leg(skeleton, side)], [-ankle[1], ball], [-ankle[1], tip]])
    by_toes = np.array([[0.0, 0.0], [0.0, 0.0], [-joint[1], tip - ball]])
    return _Foot(by_foot * (1.0 - bends)[:, None], by_toes * bends[:, None], bends, (joint - ankle)[1:])


def _leg(skeleton: Skeleton, side: str) -> float:
    """How long thigh and shin are, metres."""
    joints = skeleton.positions[[skeleton.index(side + bone) for bone in ("UpperLeg", "LowerLeg", "Foot")]]
    return float(np.linalg.norm(np.diff(joints, axis=0), axis=1).sum())


def _rolled(foot: _Foot) -> Floats:
    """Where the ankle (K, 2) is at `PITCHES`: how far ahead of its flat place, and how high."""
    step = (PITCHES[1] - PITCHES[0]) / _FINER
    down, up = round(-PITCHES[0] / step), round(PITCHES[-1] / step)
    back, on = _ways(foot, -step, down), _ways(foot, step, up)
    whole: Floats = np.concatenate([back[:0:-1], on])[::_FINER]
    return whole


def _ways(foot: _Foot, step: float, steps: int) -> Floats:
    """The same (steps + 1, 2) from the flat foot on."""
    found, at, along = np.zeros((steps + 1, 2)), foot.pitched(0.0), 0.0
    for k in range(steps + 1):
        low = float(at[:, 0].min())
        found[k] = along, -low
        above, then = at[:, 0] - low, foot.pitched((k + 1) * step)
        stands = int(np.where(above <= _ON_GROUND, (foot.toes if step > 0.0 else 0.0) - above, -np.inf).argmax())
        along, at = along - float(then[stands, 1] - at[stands, 1]), then
    return found
