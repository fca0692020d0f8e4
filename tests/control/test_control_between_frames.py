"""A body between two frames is where the judge has it, who turns joints by the shortest arcs."""

import numpy as np

from elbowroom.body.dof import DOF, LOCAL
from elbowroom.body.gait.foot_state import PITCH
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, posture_capsules
from elbowroom.body.root import FOOT, RISES, ROOT_STATE, SHOWN, TOLD, WITH_FEET, RootState, as_told
from elbowroom.control.shown.body_check import BodyCheck, Frames
from elbowroom.control.shown.standing_about import held_between
from elbowroom.experiment.judge.capsule_shapes import CapsuleShapes
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.poses import Poser
from elbowroom.experiment.judge.settings import JudgeSettings
from elbowroom.experiment.judge.soles import RaisedSoles
from elbowroom.experiment.judge.verdict import judge
from elbowroom.world.scene import Scene
from shown_between import shown_ends

AVATAR = Humanoid.default()
SHARES = np.linspace(0.0, 1.0, 41)
MODEL = body_model(AVATAR)
CHECK = BodyCheck(AVATAR, Scene.load("empty"))


def judged(roots: np.ndarray, uppers: np.ndarray) -> np.ndarray:
    """The ends (C, 6, N) of all capsules between two frames, as the judge poses them."""
    return shown_ends(AVATAR, roots, uppers, SHARES).reshape(-1, 6, len(SHARES))


def two_frames(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Root states (2, SHOWN) and upper bodies (2, LOCAL) of somebody who moves quickly."""
    roots, uppers = np.zeros((2, SHOWN)), rng.normal(0.0, 0.2, (2, LOCAL))
    roots[:, :ROOT_STATE] = RootState(forward=rng.uniform(0.1, 1.2), phase=rng.uniform(0.0, 1.0)).as_array()
    for side, x in ((0, 0.09), (1, -0.09)):
        foot = ROOT_STATE + FOOT * side
        roots[:, foot : foot + 2] = [x, rng.uniform(-0.3, 0.3)]
        roots[:, foot + PITCH] = rng.uniform(-0.3, 0.4)
    roots[:, WITH_FEET:] = rng.normal(0.0, 0.02, SHOWN - WITH_FEET)
    roots[1] += rng.normal(0.0, 0.03, SHOWN)
    roots[:, RISES : RISES + 4] = rng.uniform(0.0, 0.05, (2, 4))
    uppers[:, 2] = np.abs(uppers[:, 2])
    uppers[1] = uppers[0] + rng.normal(0.0, 0.05, LOCAL)
    uppers[1, 2] = max(uppers[1, 2], 0.0)
    return roots, uppers


def test_a_body_between_two_frames_is_where_the_judge_has_it() -> None:
    rng, farthest = np.random.default_rng(3), 0.0
    for _ in range(40):
        roots, uppers = two_frames(rng)
        frames = Frames((roots[0], roots[1]), (uppers[0], uppers[1]), (0.0, 1 / 60))
        found = held_between(CHECK.soles.body, CHECK.between(frames), frames.uppers, SHARES)
        expected = judged(roots, uppers)
        expected[:, [0, 3]] -= roots[0, 0]
        expected[:, [2, 5]] -= roots[0, 1]
        assert np.abs(found - expected).max() < 1e-5
        q = np.concatenate([roots.mean(axis=0)[:3], uppers.mean(axis=0)])[None]
        straight = posture_capsules(MODEL, q, roots.mean(axis=0)[None])[:, :, 0]
        farthest = max(farthest, float(np.abs(judged(roots, uppers)[:, :, 20] - straight).max()))
    assert farthest > 2e-3, "it is where straight interpolants are"


# Somebody goes down a stair backwards, and the right foot is put from before the body to behind it at once.
BEFORE = (
    -0.018, 2.4953, 6.2899, -0.5628, 0.001, -0.0073, 5.3388, 0.3815, -0.3473, 0.1295, 0.0, 0.2985, 0.0,
    0.0865, 0.031, -0.0002, 0.1493, 0.0001, 0.9829, 0.0, 0.0, 0.0, -0.0854, 0.3031, 0.0044, -0.0165, 0.0, 0.2,
)  # fmt: skip
AFTER = (
    -0.018, 2.4859, 6.2898, -0.5636, 0.001, -0.0072, 5.3557, 0.3757, -0.3484, 0.1343, 0.0, 0.2957, 0.0,
    0.0855, 0.006, 0.0003, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.0852, -0.0876, -0.0009, 0.0829, 0.0263, 0.6179,
)  # fmt: skip


# A foot comes down at the end of its swing; what tells of the swing ends with it.
LANDING = (
    0.0, 0.0, 0.355, 0.861, 0.096, 0.456, 0.991, 0.005, 0.0, 0.0, 0.0, 0.0, 0.0,
    0.143, 0.299, 0.086, -0.217, 0.0, 0.976, -0.27, 0.147, 0.101, -0.105, -0.237, -0.355, 0.032, 0.0, 0.0,
)  # fmt: skip
LANDED = (
    0.007, 0.013, 0.362, 0.895, 0.093, 0.416, 1.005, 0.005, 0.0, 0.0, 0.0, 0.0, 0.0,
    0.137, 0.29, 0.079, -0.227, 0.0, 0.0, 0.0, 0.0, 0.0, -0.104, -0.252, -0.362, 0.044, 0.0, 0.0,
)  # fmt: skip


def shown(values: tuple[float, ...]) -> np.ndarray:
    return as_told(np.array([*values, *[0.0] * (TOLD - len(values))]))


def test_a_foot_that_is_put_elsewhere_at_once_is_looked_at_all_the_way() -> None:
    """Straight on it is clear of the treads, with legs that turn by the shortest arcs it is in one."""
    treads = [
        {"type": "box", "center": [0.0, 0.085 * k - 0.002, 1.86 + 0.28 * k], "size": [1.8, 0.17 * k, 0.28]}
        for k in range(1, 8)
    ]
    scene, upper = Scene.of("stair", treads, finish=(0.0, 9.0)), np.zeros(LOCAL)
    check, rows = BodyCheck(AVATAR, scene), (shown(BEFORE), shown(AFTER))
    straight = [rows[0] + share * (rows[1] - rows[0]) for share in np.linspace(0.0, 1.0, 21)]
    assert min(check.clearance(row, upper, 0.0) for row in straight) > 0.0
    q = np.zeros((2, DOF))
    q[:, :3] = [row[:3] for row in rows]
    verdict = judge(ShownMotion.at_rate(q, np.stack(rows)), AVATAR, scene, JudgeSettings(mesh=False))
    assert verdict.capsules.touching > 0
    assert not check.free_between(Frames(rows, (upper, upper), (0.0, 1 / 60)))


def test_a_foot_that_lands_is_held_no_lower_on_the_way() -> None:
    """Half of what told of its swing would have it in mid-air on the plane, and so hardly held at all."""
    sill = {"type": "box", "center": [0.0, 0.05, 5.0], "size": [2.0, 0.1, 0.3]}
    check = BodyCheck(Humanoid.default(), Scene.of("sill", [sill], finish=(0.0, 9.0)))
    frames = Frames((shown(LANDING), shown(LANDED)), (np.zeros(LOCAL), np.zeros(LOCAL)), (0.0, 1 / 60))
    body = check.soles.body
    assert len(body.feet) > 0
    held = held_between(body, check.between(frames), frames.uppers, SHARES)
    lowest = (np.minimum(held[:, 1], held[:, 4]) - body.radii[:, None])[body.feet]
    assert (lowest >= np.minimum(lowest[:, :1], lowest[:, -1:]) - 5e-4).all()


# A foot leaves level ground for a slope: from one frame to the other its toes come out of the ground, and are turned.
TOES_IN, TOES_OFF = (
    (
        0.0, 0.0, 3.1416, 0.66, 0.0, 0.0, 0.1528, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0152, 0.0767, 0.0873,
        0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.0766, -0.3886, 0.0, 0.8362, 0.0308, 0.0892, 0.0026, 0.6799, 0.0,
    ),
    (
        0.0, -0.011, 3.1416, 0.66, 0.0, 0.0, 0.164, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0223, 0.0767, 0.0763,
        0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.0766, -0.3857, 0.0, 0.8502, 0.0505, 0.1186, 0.0038, 0.987, 0.0,
    ),
)  # fmt: skip


def test_a_foot_that_leaves_the_ground_is_held_no_higher_than_the_judge_has_it() -> None:
    sill = {"type": "box", "center": [0.0, 0.05, 5.0], "size": [2.0, 0.1, 0.3]}
    body = (check := BodyCheck(AVATAR, Scene.of("sill", [sill], finish=(0.0, 9.0)))).soles.body
    rows, q = np.stack([shown(TOES_IN), shown(TOES_OFF)]), np.zeros((2, DOF))
    q[:, :3] = rows[:, :3]
    motion, poser = ShownMotion.at_rate(q, rows), Poser(AVATAR)
    moments = motion.moments(60.0 * (len(SHARES) - 1))
    raised = RaisedSoles(AVATAR, poser, motion, floors=True).raised(poser.at(motion, moments), moments)
    placed = CapsuleShapes(AVATAR).placed(raised)
    judged_lowest = (placed.middles[..., 1] - np.abs(placed.half_axes[..., 1])).T - body.radii[:, None]
    frames = Frames((rows[0], rows[1]), (np.zeros(LOCAL), np.zeros(LOCAL)), (0.0, 1 / 60))
    held = held_between(body, check.between(frames), frames.uppers, SHARES)
    lowest = np.minimum(held[:, 1], held[:, 4]) - body.radii[:, None]
    assert judged_lowest[body.feet].min() < -3e-4
    assert (lowest[body.feet] < judged_lowest[body.feet] + 5e-5).all()
