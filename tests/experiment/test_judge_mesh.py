"""The judge of the skinned mesh: posed as a viewer poses it, cut into patches without loss, and able to fail."""

from collections.abc import Callable
from pathlib import Path

import coal
import numpy as np
import pytest
from numpy.typing import NDArray

from avatar_builder import MIXAMO, Recipe, build
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading.avatar_file import load_humanoid, load_humanoid_bytes
from elbowroom.body.loading.settings import LoadSettings
from elbowroom.experiment.judge.case import Case
from elbowroom.experiment.judge.crossing_triangles import crossing_depths
from elbowroom.experiment.judge.ledger import Ledger
from elbowroom.experiment.judge.mesh_judge import MeshJudge, region_of
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.obstacles import obstacles_of
from elbowroom.experiment.judge.patches import patches_of
from elbowroom.experiment.judge.poses import Posed, Poser
from elbowroom.experiment.judge.settings import JudgeSettings
from elbowroom.experiment.judge.skin import Skin, skin_of
from elbowroom.experiment.judge.stretches import stretches_of
from elbowroom.experiment.judge.verdict import judge
from elbowroom.formats.gltf import parse_gltf
from elbowroom.formats.nodes import read_nodes
from elbowroom.formats.triangles import triangle_mesh
from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.shapes import Box, Mesh, Sphere
from elbowroom.world.scene import Scene
from judged_bodies import T_POSE, gliding, random_boxes, random_postures, scene_with, upright
from odd_bodies import Body, ring_body
from sampled import sampled
from shared_data import SHARED, needs_shared

Floats = NDArray[np.float64]

STOCK = Humanoid.default()


def read_skin(humanoid: Humanoid) -> Skin:
    skin, note = skin_of(humanoid)
    assert skin is not None, note
    return skin


SKIN = read_skin(STOCK)


def odd_avatar(**recipe: object) -> Humanoid:
    return load_humanoid_bytes(build(Recipe(seed=2, **recipe)), "odd.glb")  # type: ignore[arg-type]


def poses(humanoid: Humanoid, q: Floats, roots: Floats) -> Posed:
    motion = ShownMotion.at_rate(q, roots)
    return Poser(humanoid).at(motion, motion.moments(60.0))


def as_a_viewer_poses(humanoid: Humanoid, q: Floats, roots: Floats) -> Floats:
    """All vertices (N, V, 3) by the nodes of the file: local rotations, matrices down the tree, inverse binds."""
    assert humanoid.glb is not None
    rig = humanoid.rig
    assert rig is not None
    gltf = parse_gltf(humanoid.glb, "viewer")
    tree = read_nodes(gltf)
    mesh = triangle_mesh(gltf, tree)
    local, hips = Poser(humanoid).local(q, roots)
    shown = []
    for row, root in enumerate(roots):
        rotations = tree.rotations.copy()
        rotations[rig.nodes] = rig.node_rotations(local[row])
        tree.translations[rig.nodes[0]] = rig.hips_position(hips[row])
        carried = tree.world_matrices(rotations)[mesh.nodes]
        places = np.einsum("vkij,vkj->vki", carried[..., :3, :3], mesh.offsets) + carried[..., :3, 3]
        model = rig.to_model(np.einsum("vk,vki->vi", mesh.weights, places))
        turned = quaternion.rotate(quaternion.about_axis(1, root[2]), model)
        shown.append(turned + np.array([root[0], 0.0, root[1]]))
    return np.array(shown)


def assert_posed_as_in_a_viewer(humanoid: Humanoid) -> None:
    skin = read_skin(humanoid)
    q, roots = random_postures(np.random.default_rng(3), 4)
    used = np.unique(skin.triangles)
    vertices = skin.vertices(poses(humanoid, q, roots), used)
    np.testing.assert_allclose(vertices, as_a_viewer_poses(humanoid, q, roots)[:, used], atol=2e-5)


def test_the_stock_avatar_is_posed_as_in_a_viewer() -> None:
    assert_posed_as_in_a_viewer(STOCK)


@pytest.mark.parametrize(
    "recipe",
    [
        {"vrm": "1", "spin": True, "between": True},
        {"vrm": "0", "heading": np.pi, "unit": 1.0, "root_scale": 0.5},
        {"names": MIXAMO, "prefix": "mixamorig:", "arms_down": 0.7, "spin": True, "unit": 100.0, "heading": 1.0},
    ],
)
def test_odd_rigs_are_posed_as_in_a_viewer(recipe: dict[str, object]) -> None:
    assert_posed_as_in_a_viewer(odd_avatar(**recipe))


@needs_shared
@pytest.mark.parametrize(
    "name",
    sampled(["vrm0/Godette_vrm_v4.vrm", "vrm1/debug_robot.vrm", "glb/m2m_human-male.glb", "glb/KayKit_Knight.glb"]),
)
def test_avatars_of_others_are_posed_as_in_a_viewer(name: str) -> None:
    assert SHARED is not None
    assert_posed_as_in_a_viewer(load_humanoid(SHARED / "avatars" / Path(name)))


def in_t_pose(skin: Skin, humanoid: Humanoid) -> Floats:
    """The vertices (V, 3) in T-pose."""
    rest = humanoid.skeleton.positions
    turns = np.tile(np.eye(3), (1, len(rest), 1, 1))
    vertices: Floats = skin.vertices(Posed(rest[None], turns), np.arange(len(skin.joints)))[0]
    return vertices


def test_in_t_pose_the_vertices_are_those_of_the_file() -> None:
    assert STOCK.glb is not None
    gltf = parse_gltf(STOCK.glb, "stock")
    tree = read_nodes(gltf)
    mesh = triangle_mesh(gltf, tree)
    carried = tree.world_matrices(tree.rotations)[mesh.nodes]
    places = np.einsum("vkij,vkj->vki", carried[..., :3, :3], mesh.offsets) + carried[..., :3, 3]
    np.testing.assert_allclose(in_t_pose(SKIN, STOCK), np.einsum("vk,vki->vi", mesh.weights, places), atol=1e-6)
    assert len(SKIN.triangles) == len(mesh.triangles)
    assert SKIN.left_out == 0


def test_the_root_moves_the_mesh_rigidly() -> None:
    q, roots = random_postures(np.random.default_rng(8), 1)
    moved = roots + np.array([0.7, -2.0, 1.1, 0.0, 0.0, 0.0, 0.0])
    every = np.arange(len(SKIN.joints))
    a, b = SKIN.vertices(poses(STOCK, q, roots), every)[0], SKIN.vertices(poses(STOCK, q, moved), every)[0]
    turn, pivot = quaternion.about_axis(1, 1.1), np.array([roots[0, 0], 0.0, roots[0, 1]])
    np.testing.assert_allclose(b, quaternion.rotate(turn, a - pivot) + pivot + np.array([0.7, 0.0, -2.0]), atol=1e-9)


def test_the_forearm_follows_the_elbow() -> None:
    forearm = STOCK.skeleton.index("leftLowerArm")
    own = np.flatnonzero((SKIN.joints[:, 0] == forearm) & (SKIN.weights[:, 0] > 0.999))
    assert len(own) > 50
    bent = T_POSE.copy()
    bent[9] = 1.0
    straight = poses(STOCK, T_POSE[None], np.zeros((1, 7)))
    before = SKIN.vertices(straight, own)[0]
    after = SKIN.vertices(poses(STOCK, bent[None], np.zeros((1, 7))), own)[0]
    elbow = straight.positions[0, forearm]
    turned = quaternion.rotate(quaternion.about_axis(1, -1.0), before - elbow) + elbow
    np.testing.assert_allclose(after, turned, atol=1e-3)  # up to 0.1 % of weight elsewhere


def test_patches_hold_every_triangle_once() -> None:
    patches = patches_of(SKIN).patches
    rows = np.concatenate([patch.vertices[patch.triangles] for patch in patches])
    assert sorted(map(tuple, rows)) == sorted(map(tuple, SKIN.triangles))


@pytest.mark.parametrize("wild", [False, True])
def test_patches_are_never_farther_than_they_seem(wild: bool) -> None:
    """In each pose by itself, and in stretches of poses, be they neighbours or as unlike each other as can be."""
    rng = np.random.default_rng(11)
    q, roots = random_postures(rng, 11)
    share = np.linspace(0.0, 0.05, 11)[:, None]
    one = (q, roots) if wild else tuple(each[0] + share * (each[1] - each[0]) for each in (q, roots))
    posed = poses(STOCK, *one)
    patches, every, stretches = patches_of(SKIN), np.arange(11), stretches_of(posed)
    spans = patches.spans(posed, stretches)
    of_pose = np.repeat(np.arange(len(stretches.middles)), 8)[:11]
    for obstacle in obstacles_of(scene_with(random_boxes(rng, 2))):
        wide = obstacle.world_distance(*spans)[of_pose]
        for i, patch in enumerate(patches.patches):
            bounds = patches.bounds(i, posed, every, obstacle)
            vertices = SKIN.vertices(posed, patch.vertices)
            np.testing.assert_allclose(patch.carried.vertices(posed, every), vertices, atol=1e-9)
            beyond = np.abs(obstacle.seen_from(vertices)) - obstacle.half_size
            true = np.linalg.norm(np.maximum(beyond, 0.0), axis=-1).min(axis=1)
            assert (bounds <= true + 1e-9).all()
            assert (wide[:, i] <= true + 1e-9).all()


def crumpled(rng: np.random.Generator) -> Obstacles:
    """A mesh of triangles of all sizes and slants about the body, and a box."""
    sizes = 10.0 ** rng.uniform(-2.0, 0.3, (60, 1, 1))
    corners = rng.uniform([-1.5, 0.0, -1.5], [1.5, 1.8, 1.5], (60, 1, 3)) + sizes * rng.normal(size=(60, 3, 3))
    corners[:, :, 0] += 0.8  # mostly beside the body
    mesh = Mesh(corners.reshape(-1, 3), np.arange(180).reshape(-1, 3))
    turns = quaternion.normalize(rng.normal(size=(2, 4)))
    centers = np.array([[0.1, 0.05, 0.0], [1.0, 1.0, 0.3]])
    return Obstacles((mesh, Box((0.3, 0.3, 0.3))), centers, turns, ("heap", "box"), ground=-9.0)


def beside(rng: np.random.Generator) -> Obstacles:
    boxes = random_boxes(rng, 2)
    boxes.centers[0, 0] += 0.8  # mostly beside the body
    return boxes


@pytest.mark.parametrize("place", [beside, crumpled])
@pytest.mark.parametrize("seed", sampled(range(2)))
def test_nothing_is_missed(seed: int, place: Callable[[np.random.Generator], Obstacles]) -> None:
    """The whole skin in one piece, against whole meshes, and every contact asked for, gives the same."""
    rng = np.random.default_rng(seed)
    q, roots = random_postures(rng, 4)
    scene = scene_with(place(rng))
    posed, ledger = poses(STOCK, q, roots), Ledger(1e-5)
    MeshJudge(SKIN, STOCK.skeleton, obstacles_of(scene)).judge(Case(posed, np.arange(4) / 60, 0, ledger))
    vertices, obstacles = SKIN.vertices(posed, np.arange(len(SKIN.joints))), whole_obstacles(scene)
    whole = np.array([min(whole_distance(points, *obstacle) for obstacle in obstacles) for points in vertices])
    assert ledger.least is not None
    assert ledger.least.clearance == pytest.approx(whole.min(), abs=1e-6)
    assert ledger.touching == set(np.flatnonzero(whole < -1e-5))


def whole_obstacles(scene: Scene) -> list[tuple[object, object, Floats | None]]:
    """Shapes of the library and where they are: a mesh is one of them, and has its corners (T, 3, 3) in the world."""
    found = list[tuple[object, object, Floats | None]]()
    for _, shape, center, turn in scene.obstacles:
        matrix = quaternion.to_matrix(turn)
        if isinstance(shape, Mesh):
            there = shape.vertices @ matrix.T + center
            found.append((triangles(there, shape.faces), coal.Transform3s(), there[shape.faces]))
        else:
            found.append((coal.Box(*shape.size), coal.Transform3s(matrix, center), None))  # type: ignore[union-attr]
    return found


def triangles(points: Floats, faces: NDArray[np.int64]) -> object:
    model = coal.BVHModelOBBRSS()
    model.beginModel(len(faces), len(points))
    model.addVertices(points)
    model.addTriangles(faces)
    model.endModel()
    return model


def whole_distance(points: Floats, shape: object, place: object, corners: Floats | None) -> float:
    bodies = (triangles(points, SKIN.triangles), coal.Transform3s(), shape, place)
    distance = coal.distance(*bodies, coal.DistanceRequest(), coal.DistanceResult())
    if distance > 0.0:
        return float(distance)
    request, result = coal.CollisionRequest(), coal.CollisionResult()
    request.num_max_contacts, request.enable_contact = 100 * len(SKIN.triangles), True
    coal.collide(*bodies, request, result)
    contacts = result.getContacts()
    if corners is None:
        return float(min(contact.penetration_depth for contact in contacts))
    mine, theirs = ([getattr(contact, side) for contact in contacts] for side in ("b1", "b2"))
    return -float(crossing_depths(points[SKIN.triangles[mine]], corners[theirs]).max())


def test_a_fingertip_in_a_wall_is_reported_with_its_depth() -> None:
    points = SKIN.vertices(poses(STOCK, T_POSE[None], np.zeros((1, 7))), np.arange(len(SKIN.joints)))[0]
    q, roots = gliding(T_POSE, 7, speed=0.0)
    roots[:, 0] = q[:, 0] = 0.005 * np.arange(7)  # the left hand goes outwards, 5 mm a frame
    face = points[:, 0].max() + 0.022
    wall = upright(((face + 0.5, 1.0, 0.0), (1.0, 2.0, 2.0)))
    verdict = judge(ShownMotion.at_rate(q, roots), STOCK, scene_with(wall))
    assert not verdict.clean
    assert verdict.mesh is not None
    (contact,) = verdict.mesh.contacts
    assert (contact.part, contact.obstacle) == ("leftArm", "box 0")
    assert verdict.mesh.deepest == pytest.approx(0.008, abs=1e-5)
    assert contact.first == pytest.approx(4.5 / 60, abs=1 / 240)  # 22 mm after 4.4 frames
    assert contact.deepest.time == pytest.approx(0.1)
    assert verdict.triangles == len(SKIN.triangles)


def test_a_fingertip_through_a_sheet_is_as_deep_as_it_has_to_be_drawn_out() -> None:
    """Of two meshes the other library tells a depth of metres, where one has to be moved by millimetres."""
    points = SKIN.vertices(poses(STOCK, T_POSE[None], np.zeros((1, 7))), np.arange(len(SKIN.joints)))[0]
    sheet = Mesh(
        np.array([[0.0, -2.0, -2.0], [0.0, 4.0, 0.0], [0.0, -2.0, 2.0]]),
        np.array([[0, 1, 2]]),
    )
    face = np.array([[points[:, 0].max() - 0.003, 1.0, 0.0]])
    scene = scene_with(Obstacles((sheet,), face, quaternion.IDENTITY[None], ("sheet",)))
    verdict = judge(ShownMotion.at_rate(*gliding(T_POSE, 2, speed=0.0)), STOCK, scene)
    assert verdict.mesh is not None
    assert 0.002 < verdict.mesh.deepest <= 0.003 + 1e-9


def test_a_clean_mesh_tells_its_clearance() -> None:
    points = SKIN.vertices(poses(STOCK, T_POSE[None], np.zeros((1, 7))), np.arange(len(SKIN.joints)))[0]
    ceiling = upright(((0.0, points[:, 1].max() + 0.507, 0.0), (3.0, 1.0, 3.0)))
    verdict = judge(ShownMotion.at_rate(*gliding(T_POSE, 3, 0.1)), STOCK, scene_with(ceiling))
    assert verdict.mesh is not None
    assert verdict.mesh.least is not None
    assert verdict.mesh.least.part == "head"
    assert verdict.mesh.least.clearance == pytest.approx(0.007, abs=1e-6)
    assert verdict.mesh.deepest == 0.0


def test_a_triangle_without_area_touches_nothing() -> None:
    """The other library takes one with two corners in one place to be in the middle of every ball."""
    whole = ring_body()
    tip = np.flatnonzero(np.array(whole.bones) == "head")[1]  # the octahedron's upper corner
    collapsed = np.array([[tip, tip, tip - 1]])
    body = Body(whole.points, whole.bones, np.concatenate([whole.triangles, collapsed]))
    ball = Obstacles((Sphere(0.2),), whole.points[[tip]] + [0.0, 0.24, 0.0], quaternion.IDENTITY[None], ("ball",))
    verdict = judge(ShownMotion.at_rate(*gliding(T_POSE, 2, speed=0.0)), odd_avatar(body=body), scene_with(ball))
    assert verdict.triangles == len(body.triangles)
    assert verdict.mesh is not None
    assert verdict.mesh.touching == 0
    assert verdict.mesh.least is not None
    assert 0.0 < verdict.mesh.least.clearance < 0.1


def test_without_a_mesh_only_capsules_are_judged() -> None:
    scene = scene_with(upright(((0.0, 3.0, 0.0), (1.0, 1.0, 1.0))))
    motion = ShownMotion.at_rate(*gliding(T_POSE, 3, 0.1))
    for verdict, note in (
        (judge(motion, proportional_humanoid(1.7), scene), "no file"),
        (judge(motion, odd_avatar(mesh=False), scene), "no mesh"),
        (judge(motion, STOCK, scene, JudgeSettings(mesh=False)), "not asked for"),
    ):
        assert verdict.mesh is None
        assert note in verdict.mesh_note
        assert verdict.triangles == 0


@pytest.mark.parametrize("bone", ["head", "hips"])
def test_what_planning_took_for_no_body_is_not_judged(bone: str) -> None:
    """A mesh that hangs on one bone, be it a ball on the head or a whole figure whose skin has no weights."""
    whole = ring_body()
    token = Body(whole.points * (1.0, 1.2, 1.0), (bone,) * len(whole.points), whole.triangles)
    humanoid = odd_avatar(vrm="1", body=token)
    assert not humanoid.meta.has_body
    points = whole.points * (1.0, 1.2, 1.0)
    ceiling = upright(((0.0, points[:, 1].max() + 0.49, 0.0), (3.0, 1.0, 3.0)))  # 1 cm into the mesh
    verdict = judge(ShownMotion.at_rate(*gliding(T_POSE, 3, 0.1)), humanoid, scene_with(ceiling))
    assert verdict.clean
    assert verdict.mesh is None
    assert "average proportions" in verdict.mesh_note


def test_hair_that_is_counted_in_is_judged(tmp_path: Path) -> None:
    path = tmp_path / "a.glb"
    path.write_bytes(build(Recipe(body=ring_body())).replace(b'"name":"rightHand"', b'"name":"rightHair"'))
    (tmp_path / "a.glb.bones.json").write_text('{"rightHand": null, "rightLowerArm": "rightLowerArm"}')
    without, with_it = (skin_of(load_humanoid(path, LoadSettings(include_hair=hair)))[0] for hair in (False, True))
    assert without is not None
    assert with_it is not None
    assert len(with_it.triangles) == len(ring_body().triangles)
    assert len(without.triangles) < len(with_it.triangles)
    everything = range(int(without.joints.max()) + 1)  # joints
    assert np.array_equal(without.most_on(everything), np.unique(without.triangles))  # what is left out is no sole


def test_regions() -> None:
    bones = ("hips", "upperChest", "neck", "leftEye", "leftIndexDistal", "rightShoulder", "rightUpperLeg", "leftToes")
    regions = ["trunk", "trunk", "head", "head", "leftArm", "rightArm", "rightLeg", "leftLeg"]
    assert [region_of(bone) for bone in bones] == regions
