"""How recorded feet go beside the root: where they stand, how they roll and swing, over the mean stride.

A foot is told as `body/gait/foot_state.py` has it: where it would be if it lay flat, how it is pitched about its ball
or its heel, and how high its sole is lifted.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.cycle import GaitShape
from elbowroom.body.gait.own_steps import AHEAD, ASIDE, KEYS, LIFT, PATH, PITCH, YAW, OwnSteps
from elbowroom.body.gait.stride import stride_of
from elbowroom.body.gait.tilted_foot import rolled
from elbowroom.clips.body_motion import BodyMotion
from elbowroom.clips.carried import facing, middle_of_hips
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

_HIP, _ANKLE, _THIGH, _SHIN = 0, 3, 8, 9  # columns of `GaitShape.legs`
_X, _Z = 0, 1  # of what is seen of a foot; then its yaw, its pitch and its lift, as in the cycle
SPAN = 4  # numbers of a leg from hip to ankle
_SAMPLES = 256  # of a stride, in which landing and lifting are looked for
_MIDDLE = 0.3  # of the stride after the strike: a foot stands then
_LANDS, _LIFTS = (-0.15, 0.15), (0.45, 0.8)  # parts of the stride about the strike
_SLOW = 0.1  # of the foot's greatest speed: slower it stands
_HIGH = 0.015  # metres of a standard leg: a foot that is higher has not landed
_STANDS = (0.15, 0.4)  # of the stride since the strike: every foot stands then
_FLAT = (0.3, 0.7)  # of the stance
_HOMES = np.array([[-0.1, -0.25, -0.4], [0.25, 0.2, 0.7]])  # least and most: metres of a standard leg, radians
_MOST = np.zeros((2, PATH))
_MOST[:, AHEAD], _MOST[:, ASIDE], _MOST[:, YAW] = (-0.3, 0.3), (-0.2, 0.2), (-0.7, 0.7)
_MOST[:, PITCH], _MOST[:, LIFT] = (-0.6, 1.2), (0.0, 0.35)


def legs_seen(motion: BodyMotion, gait: GaitShape) -> tuple[Floats, Floats, Floats]:
    """Heights (F,) of the hips beside those over a straight standing leg; both feet in each frame, (F, 2, PATH).

    Of a foot: x and z of its flat ankle from the middle of the hips, yaw, pitch, lift, in the axes of the heading. And
    the way from the leg's joint at the hip to the ankle, with its length, (F, 2, SPAN).
    """
    middle, heading = middle_of_hips(motion), facing(motion)
    seen, spans = np.empty((len(motion), 2, PATH)), np.empty((len(motion), 2, SPAN))
    turned = quaternion.about_axis(1, -heading)
    for side, name in enumerate(("left", "right")):
        foot, legs = f"{name}Foot", gait.legs[side]
        ankle, turn = motion.position(foot), quaternion.multiply(turned, motion.turn(foot))
        across, ahead = (quaternion.rotate(turn, axis) for axis in (np.eye(3)[0], np.eye(3)[2]))
        yaw = np.arctan2(-across[:, 2], across[:, 0])
        pitch = np.arctan2(-ahead[:, 1], ahead[:, 0] * np.sin(yaw) + ahead[:, 2] * np.cos(yaw))
        along, height = rolled(legs, pitch)
        x, _, z = quaternion.rotate(turned, ankle - middle).T
        seen[:, side] = np.stack(
            [x - along * np.sin(yaw), z - along * np.cos(yaw), yaw, pitch, ankle[:, 1] - height], axis=1
        )
        spans[:, side, :3] = quaternion.rotate(turned, ankle - motion.position(f"{name}UpperLeg"))
    spans[..., 3] = np.linalg.norm(spans[..., :3], axis=-1)
    straight = gait.legs[:, [_ANKLE + 1, _THIGH, _SHIN]].sum(axis=1).mean()
    return middle[:, 1] - straight, seen, spans


class Recorded(NamedTuple):
    """The steps of a recorded walk."""

    steps: OwnSteps
    ground: (
        Floats  # (n,) the height of what they stand on, metres, as legs would have it that are as long as in the mean
    )
    lands: float  # the phase at which the left foot lands, in the mean of both feet


def recorded_steps(feet: Floats, spans: Floats, gait: GaitShape, speed: float) -> Recorded:
    """The steps of a walk at so many m/s; `feet` (n, 2, PATH) are told from the root, at even phases.

    They are a mean of many, and so are `spans` (n, 2, SPAN). Where these differ, the mean way to an ankle is shorter
    than legs are in the mean, and knees would bend for that: so feet are taken to be as much lower.
    """
    stride, feet = _stride(feet), feet.copy()
    feet[..., LIFT] -= spans[..., 3] - np.linalg.norm(spans[..., :3], axis=-1)
    both = [_Foot(feet[:, side], 0.5 * side, stride, gait.scale) for side in range(2)]
    ground = _ground_under(feet, both)
    homes, cycle = np.empty((2, 3)), np.zeros((2, 2 * KEYS + 1, PATH))
    for side, foot in enumerate(both):
        outward, legs = 1.0 if side == 0 else -1.0, gait.legs[side]
        x, z, yaw = foot.home()
        z -= legs[_ANKLE + 2] - legs[_HIP + 2]
        homes[side] = outward * (x - legs[_ANKLE]) / gait.scale, z / gait.scale, outward * yaw
        cycle[side] = foot.cycle(ground)
    cycle[:, :, [ASIDE, LIFT]] /= gait.scale
    duty = float(np.mean([foot.lifts - foot.lands for foot in both])) - stride_of(gait.scale, speed, 0.0, 0.0).duty
    steps = OwnSteps(speed, duty, np.clip(homes, *_HOMES), np.clip(cycle, *_MOST))
    return Recorded(steps, ground, float(np.mean([foot.lands for foot in both])))


def _stride(feet: Floats) -> float:
    """How far the root goes in a stride, metres: as far as feet that stand go back under it."""
    parts = np.linspace(*_STANDS, 9)
    ways = [around(feet[:, side, [_Z]], 0.5 * side + parts)[:, 0] for side in range(2)]
    return float(-np.mean([np.polyfit(parts, way, 1)[0] for way in ways]))


def _ground_under(feet: Floats, both: list["_Foot"]) -> Floats:
    """Height (n,) of what both feet stand on: recorded bodies float and sink by centimetres.

    What a viewer sees is how a leg is bent over the foot that stands.
    """
    phases, lifts = np.arange(len(feet)) / len(feet), feet[..., LIFT]
    stands = np.stack([foot.stands(phases) for foot in both], axis=1)
    none = ~stands.any(axis=1)
    stands[none] = lifts[none] <= lifts[none].min(axis=1, keepdims=True)
    ground: Floats = (stands * lifts).sum(axis=1) / stands.sum(axis=1)
    return ground


class _Foot:
    """One foot over its cycle, which begins where its ankle is farthest ahead of the hips."""

    def __init__(self, rows: Floats, first: float, stride: float, scale: float) -> None:
        """`rows` (n, PATH) are its places from the root at even phases; its cycle begins at the `first`.

        A `stride` is in metres, `scale` that of the legs.
        """
        self._rows, self._first, self._stride = rows, first, stride
        parts = np.arange(_SAMPLES) / _SAMPLES
        ahead = self._at(parts)[:, _Z]
        rate = 0.5 * _SAMPLES * (np.roll(ahead, -1) - np.roll(ahead, 1)) + self._stride
        moves, lift = rate > _SLOW * rate.max(), self._at(parts)[:, LIFT]
        later, high = (
            parts[moves & (parts > _MIDDLE)],
            lift > _HIGH * scale + np.median(around(rows, first + np.linspace(*_STANDS, 9))[:, LIFT]),
        )
        lands = max(parts[(moves | high) & (parts <= _MIDDLE)].max(initial=-1.0), later.max(initial=0.0) - 1.0)
        self.lands, self.lifts = np.clip(lands, *_LANDS).item(), np.clip(later.min(initial=1.0), *_LIFTS).item()

    def stands(self, phases: Floats) -> NDArray[np.bool_]:
        """Whether it stands at phases (n,) of the stride."""
        since = np.mod(phases - self._first - self.lands, 1.0)
        stands: NDArray[np.bool_] = since <= self.lifts - self.lands
        return stands

    def _at(self, parts: Floats) -> Floats:
        return around(self._rows, self._first + parts)

    def _over_ground(self, parts: Floats) -> Floats:
        rows = self._at(parts)
        rows[:, _Z] += self._stride * parts
        return rows

    def home(self) -> tuple[float, float, float]:
        """Where it is from the root in the middle of its stance: x, z, yaw."""
        middle = 0.5 * (self.lands + self.lifts)
        phases = self.lands + (self.lifts - self.lands) * np.linspace(*_FLAT, 9)
        x, z, yaw = self._over_ground(phases)[:, :3].mean(axis=0)
        return float(x), float(z - self._stride * middle), float(yaw)

    def cycle(self, ground: Floats) -> Floats:
        """From landing to landing, (2 KEYS + 1, PATH), see `OwnSteps`; over a `ground` (n,) at even phases."""
        parts = np.arange(KEYS + 1) / KEYS
        stance = self.lands + (self.lifts - self.lands) * parts
        swing = self.lifts + (1.0 + self.lands - self.lifts) * parts
        rows, out = self._over_ground(swing), np.zeros((2 * KEYS + 1, PATH))
        even = (parts**2 * (3.0 - 2.0 * parts))[:, None]
        away = rows[:, :3] - (rows[0, :3] + even * (rows[-1, :3] - rows[0, :3]))
        out[KEYS:, ASIDE], out[KEYS:, AHEAD] = away[:, _X], away[:, _Z] / max(rows[-1, _Z] - rows[0, _Z], 1e-3)
        out[KEYS:, YAW] = away[:, 2]
        out[KEYS + 1 : -1, LIFT] = (rows[:, LIFT] - around(ground[:, None], self._first + swing)[:, 0])[1:-1]
        out[: KEYS + 1, PITCH], out[KEYS:-1, PITCH] = self._at(stance)[:, PITCH], rows[:-1, PITCH]
        out[-1, PITCH] = out[0, PITCH]
        return out


def around(rows: Floats, phases: Floats) -> Floats:
    """Rows (n, k) at even phases of a stride, at phases (m,): (m, k)."""
    at, count = np.arange(len(rows)), len(rows)
    return np.stack([np.interp(phases * count, at, row, period=count) for row in rows.T], axis=1)
