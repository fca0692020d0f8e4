"""The soles of an avatar: a few points of each foot that touch the ground first, however the foot is turned."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.cycle import gait_shape
from elbowroom.body.humanoid import Humanoid
from elbowroom.experiment.judge.poses import Posed
from elbowroom.experiment.judge.skin import Carried, Skin, skin_of

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_THICK = 0.025  # of a leg: what is so near the lowest point of a foot in T-pose is its sole
_BALL = 6  # column of `GaitShape.legs`
_DIRECTIONS, _SPREAD = 48, 24  # in which the farthest points are taken, and points spread over the whole sole besides


class SolePoints(NamedTuple):
    """Points of one foot, as its joints carry them."""

    carried: Carried
    flat: Floats  # (P, 2) how far each is ahead of the toes' joint, and above the lowest, as the foot stands flat

    def points(self, posed: Posed) -> Floats:
        """Where they are (N, P, 3) in N poses."""
        return self.carried.vertices(posed, np.arange(len(posed.positions)))


def soles_of(humanoid: Humanoid) -> tuple[SolePoints, SolePoints]:
    """The left and the right sole: of the avatar's own surface, or of its skeleton where it has none."""
    skin, _ = skin_of(humanoid)
    left, right = (_of_skin(humanoid, skin, side) for side in ("left", "right"))
    return left, right


def _of_skin(humanoid: Humanoid, skin: Skin | None, side: str) -> SolePoints:
    skeleton = humanoid.skeleton
    own = [skeleton.index(side + part) for part in ("Foot", "Toes") if skeleton.has(side + part)]
    if skin is None:
        return _of_skeleton(humanoid, side)
    mine = skin.most_on(own)
    if not len(mine):
        return _of_skeleton(humanoid, side)
    upright = Posed(skeleton.positions[None], np.broadcast_to(np.eye(3), (1, len(skeleton.names), 3, 3)))
    places = skin.vertices(upright, mine)[0]
    leg = 2.0 * gait_shape(skeleton).half_leg
    low = np.flatnonzero(places[:, 1] < places[:, 1].min() + _THICK * leg)
    kept = np.unique(np.concatenate([low[[places[low][:, 2].argmin()]], _outermost(places), low[_spread(places[low])]]))
    return _sole(skin.carried(mine[kept]), places[kept], _ball(humanoid, side))


def _sole(carried: Carried, places: Floats, ball: float) -> SolePoints:
    """The sole of points with those places (P, 3) in T-pose, of a foot whose toes' joint is so far ahead, metres."""
    return SolePoints(carried, np.stack([places[:, 2] - ball, places[:, 1] - places[:, 1].min()], axis=1))


def _ball(humanoid: Humanoid, side: str) -> float:
    """How far ahead the joint of the toes is in T-pose, or what the foot rolls over where it has none, metres."""
    ankle = humanoid.skeleton.positions[humanoid.skeleton.index(f"{side}Foot")]
    return float(ankle[2] + gait_shape(humanoid.skeleton).legs[0 if side == "left" else 1, _BALL])


def _outermost(places: Floats) -> Ints:
    """The points that lie farthest down in directions that a foot is turned to."""
    angles = np.linspace(-0.5 * np.pi, 0.5 * np.pi, _DIRECTIONS)
    ways = [
        np.stack([0 * angles, -np.cos(angles), np.sin(angles)]),
        np.stack([np.sin(angles), -np.cos(angles), 0 * angles]),
    ]
    farthest: Ints = np.concatenate([(places @ way).argmax(axis=0) for way in ways])
    return farthest


def _spread(places: Floats) -> Ints:
    """Points all over, each the farthest from those before it."""
    chosen, away = [0], np.full(len(places), np.inf)
    for _ in range(min(_SPREAD, len(places)) - 1):
        away = np.minimum(away, np.linalg.norm(places - places[chosen[-1]], axis=1))
        chosen.append(int(away.argmax()))
    return np.array(chosen)


def _of_skeleton(humanoid: Humanoid, side: str) -> SolePoints:
    """Heel, ball and tip of the toes, by the bones and the foot's capsule."""
    skeleton, capsules = humanoid.skeleton, humanoid.capsules
    foot = skeleton.index(f"{side}Foot")
    front = skeleton.index(f"{side}Toes") if skeleton.has(f"{side}Toes") else foot
    ankle, toes = skeleton.positions[foot], skeleton.positions[front]
    at = capsules.names.index(f"{side}Foot")
    ahead = max(float(capsules.starts[at, 2]), float(capsules.ends[at, 2])) + float(capsules.radii[at])
    heel = 0.16 * gait_shape(skeleton).half_leg
    offsets = np.array([[0.0, -ankle[1], -heel], [0.0, -ankle[1], toes[2] - ankle[2]], [0.0, -toes[1], 0.0]])
    offsets[2] = [0.0, -toes[1], ankle[2] + ahead - toes[2]]
    points = Skin(np.array([[0, 1, 2]]), np.array([[foot], [foot], [front]]), np.ones((3, 1)), offsets[:, None], 0)
    places = offsets + np.stack([ankle, ankle, toes])
    return _sole(points.carried(np.arange(3)), places, _ball(humanoid, side))
