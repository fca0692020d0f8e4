"""Courses: the same everywhere, as their level says, and usable as scenes."""

from itertools import pairwise

import numpy as np
import pytest

from avatar_builder import Recipe, build
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.loading.avatar_file import load_humanoid_bytes
from elbowroom.errors import InputError
from elbowroom.experiment.gauntlet.course import CourseMaker, make_course
from elbowroom.experiment.gauntlet.draw import Draw
from elbowroom.experiment.gauntlet.levels import BEND_TWIST, LEVELS
from elbowroom.experiment.gauntlet.line import CourseLine, LineTurn, steady_walk
from elbowroom.experiment.gauntlet.names import LARGEST_SEED
from elbowroom.experiment.gauntlet.placing import PlacedBox
from elbowroom.world.scene import Scene
from gauntlet_courses import SAMPLE, course, stock
from odd_bodies import Body, box_body, ring_body
from sampled import sampled

# A body of average proportions: these change only with the generator itself, and then the gauntlet is another one.
PINNED = {
    (1, 0): "af0881faaef583ae4d54bc355d8b4fa06b9cfb07c45ad007aa6f6aed2bb02512",
    (2, 7): "9da3c271133133310a6680e2c69d9806cf9012f929fe08b078c5921a61523c40",
    (3, 1): "b421ffab473b3749b51c9105e16692e22a3ee7c431294b8430db66f81c8e813e",
    (4, 3): "632e4606dcfae32f50e6733d9294eae33f63d71104c984e32dd31fcdaaa7a155",
    (5, 2): "a1c70a367da16fa691643fdca9fffe0b1672dde566c28b43026f7de6bad2a94c",
}
# The stock avatar: these change with its collision body too.
PINNED_STOCK = {
    (1, 0): "a9c8207154b17da4b531fb5221d2e16cd4a53e62c23a263499f60efdfc478dfc",
    (3, 1): "05565824eab2af65b3cb17d78ac334ba0a2a1a9de32598527e6191d7c3d31b2b",
    (5, 2): "370e6e06067a2610d5f4ed5562ef3fc2e926c0795f92e6a3f8de410f966eaa22",
}


@pytest.mark.parametrize(("level", "seed"), PINNED)
def test_courses_are_the_same_on_every_machine(level: int, seed: int) -> None:
    maker = CourseMaker.of(proportional_humanoid(1.72))
    assert maker.course(level, seed).fingerprint == PINNED[level, seed]


@pytest.mark.parametrize(("level", "seed"), sampled(PINNED_STOCK, 2))
def test_courses_of_the_stock_avatar_are_the_same_on_every_machine(level: int, seed: int) -> None:
    assert course(level, seed).fingerprint == PINNED_STOCK[level, seed]


def test_the_stream_of_chance_is_pinned() -> None:
    draw = Draw(3, 14, 15)
    drawn = [draw.between((-1.0, 1.0)), draw.whole(0, 99), draw.chance(0.5), draw.sign(), draw.one_of("abc")]
    assert drawn == [-0.295, 53, False, 1, "b"]


def test_a_course_does_not_depend_on_what_was_made_before() -> None:
    again = CourseMaker.of(stock()[0]).course(2, 1)
    assert again.fingerprint == course(2, 1).fingerprint == make_course(2, 1).fingerprint
    assert again.scene.to_dict() == course(2, 1).scene.to_dict()
    assert np.array_equal(again.certificate.uppers, course(2, 1).certificate.uppers)


def test_seeds_and_levels_give_different_courses() -> None:
    assert len({course(level, seed).fingerprint for level, seed in SAMPLE}) == len(SAMPLE)


@pytest.mark.parametrize(("level", "seed"), SAMPLE)
def test_a_course_is_as_its_level_says(level: int, seed: int) -> None:
    made, settings = course(level, seed), LEVELS[level]
    least, most = settings.passages
    assert least <= len(made.passages) <= most
    assert sum(passage.long for passage in made.passages) == settings.long_passages
    assert all(passage.end - passage.begin >= 3.0 for passage in made.passages if passage.long)
    assert all(after.begin - before.end >= settings.gap[0] - 1e-9 for before, after in pairwise(made.passages))
    assert made.certificate.margin == settings.margin
    assert settings.surely is None or any(passage.asks == settings.surely for passage in made.passages)
    assert settings.turn > 0.0 or made.line.straight
    assert all(len(group) >= settings.obstacles[0] for group in made.groups)
    assert sorted(index for group in made.groups for index in group) == list(range(len(made.scene.obstacles)))


def test_long_passages_have_an_obstacle_of_3_metres() -> None:
    for level, seed in SAMPLE:
        made = course(level, seed)
        longest = 2.0 * made.scene.obstacles.half_sizes[:, 2]
        for passage, group in zip(made.passages, made.groups, strict=True):
            if passage.long:
                assert longest[list(group)].max() >= 3.0


def test_levels_get_harder() -> None:
    levels = [LEVELS[number] for number in range(1, 6)]
    assert [level.margin for level in levels] == [0.06, 0.05, 0.04, 0.03, 0.02]
    for easier, harder in pairwise(levels):
        assert harder.passages >= easier.passages
        assert harder.gap[0] < easier.gap[0]
        assert harder.obstacles >= easier.obstacles
        assert harder.turn >= easier.turn
    assert levels[3].surely == levels[4].surely == BEND_TWIST


def test_some_courses_of_the_higher_levels_wind_and_some_do_not() -> None:
    assert {course(level, seed).line.straight for level, seed in SAMPLE if level >= 3} == {True, False}


@pytest.mark.parametrize(("level", "seed"), SAMPLE)
def test_a_course_is_a_scene_file(level: int, seed: int) -> None:
    made = course(level, seed)
    document = made.scene.to_dict()
    assert Scene.from_dict(document).to_dict() == document
    assert not made.scene.finished(made.scene.start)
    ends = made.line.points(np.array([made.line.length]))[0]
    assert made.scene.finish.passed(*ends)


def test_numbers_of_a_scene_are_whole_millimetres() -> None:
    for level, seed in SAMPLE:
        boxes = course(level, seed).scene.obstacles
        for values in (boxes.centers, 2.0 * boxes.half_sizes):
            assert np.allclose(1e3 * values, np.round(1e3 * values), atol=1e-9)


@pytest.mark.parametrize(("level", "seed"), [(0, 0), (6, 0), (1, -1), (1, LARGEST_SEED + 1)])
def test_what_is_no_level_or_seed_is_refused(level: int, seed: int) -> None:
    with pytest.raises(InputError, match="is not a whole number"):
        make_course(level, seed)


def test_an_obstacle_is_the_same_in_the_generator_and_in_the_scene() -> None:
    rng = np.random.default_rng(5)
    for _ in range(20):
        turn, size = tuple(rng.uniform(-3.0, 3.0, 3).tolist()), tuple(rng.uniform(0.1, 1.0, 3).tolist())
        document = course(1, 0).scene.to_dict()
        document["obstacles"] = [{"type": "box", "center": [9.0, 1.0, 9.0], "size": list(size), "euler": list(turn)}]
        row = Scene.from_dict(document).obstacles.standing.rows[0, :15]
        placed = PlacedBox("box", (9.0, 1.0, 9.0), turn, size)
        assert np.allclose(placed.row(), row, atol=1e-12)


def test_a_line_is_the_integral_of_its_heading() -> None:
    line = CourseLine(8.0, (LineTurn(1.0, 3.0, 0.4), LineTurn(4.0, 6.5, -0.5)))
    way = np.linspace(0.0, 8.0, 4001)
    points, heading = line.points(way), line.heading(way)
    steps = np.diff(points, axis=0) / np.diff(way)[:, None]
    middle = 0.5 * (heading[1:] + heading[:-1])
    assert np.allclose(steps, np.stack([np.sin(middle), np.cos(middle)], axis=1), atol=2e-3)
    assert np.allclose(np.gradient(heading, way), line.curvature(way), atol=1e-3)
    assert line.heading(8.0) == pytest.approx(-0.1)
    assert line.nearest(float(line.points(5.0)[0]), float(line.points(5.0)[1]), 4.5) == pytest.approx(5.0, abs=0.005)
    x, _, z = line.spot(5.0).world(0.3, 1.0, 0.0)
    assert np.allclose((x, z) - line.points(5.0), 0.3 * left_of(line, 5.0))


def left_of(line: CourseLine, way: float) -> np.ndarray:
    heading = float(line.heading(way))
    return np.array([np.cos(heading), -np.sin(heading)])


def test_a_walk_moves_as_its_states_say() -> None:
    walk = steady_walk(CourseLine(6.0, (LineTurn(1.0, 3.0, 0.4),)), 0.9, 240.0)
    velocity = np.gradient(walk.states[:, :2], walk.times, axis=0)
    heading = walk.states[:, 2]
    ahead = walk.states[:, 3, None] * np.stack([np.sin(heading), np.cos(heading)], axis=1)
    assert np.abs(velocity - ahead)[2:-2].max() < 0.02
    assert np.allclose(np.gradient(heading, walk.times)[2:-2], walk.states[2:-2, 5], atol=0.02)
    assert walk.states[0, 3] == 0.0
    assert walk.way[-1] >= 6.0
    assert np.all(np.diff(walk.states[:, 6]) > 0.0)


@pytest.mark.parametrize(
    ("body", "unit"),
    [
        pytest.param(ring_body(), 1.0, id="low-poly", marks=pytest.mark.long),
        pytest.param(ring_body(head=0.24), 1.0, id="with a big head"),
        pytest.param(ring_body(), 0.36, id="as small as a doll", marks=pytest.mark.long),
        pytest.param(box_body(0.35), 0.6, id="a small one of boxes", marks=pytest.mark.long),
    ],
)
def test_bodies_of_other_builds_get_courses(body: Body, unit: float) -> None:
    humanoid = load_humanoid_bytes(build(Recipe(vrm="1", body=body, unit=unit)), "odd.vrm")
    made = CourseMaker.of(humanoid).course(3, 0)
    assert len(made.groups) == len(made.passages)
    assert all(made.groups)
    assert made.certificate.margin == pytest.approx(0.04 * min(1.0, humanoid.skeleton.height / 1.51), abs=0.01)
