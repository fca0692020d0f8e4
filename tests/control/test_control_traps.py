"""Nobody is trapped: from wherever steering has led, a command towards free space moves the avatar."""

import math

import numpy as np
import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.control.shown.body_check import BodyCheck
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene
from gauntlet_courses import course
from sampled import sampled

AVATAR = Humanoid.default()
DT = 1 / 60
# Before the sideboard of scene C, knees 1.5 cm from it: a stride in any direction brings one into it.
HARD_BY = RootState(-0.6107459119754125, 1.2540209971435816, 6.71346379465214, 0.0, 0.0, 0.0, 0.0)
AWAY = [Command(forward=-1.0), Command(strafe=1.0), Command(strafe=-1.0), Command(forward=-0.7, strafe=0.7)]
DIRECTIONS = [Command(forward=1.0, direction=k * math.pi / 4) for k in range(2, 7)]


def moved(controller: Controller, command: Command, seconds: float) -> float:
    """How far it gets in so many seconds, metres; nothing is touched."""
    start = controller.root
    for _ in range(round(seconds / DT)):
        assert not controller.step(command, DT).touching
    return math.dist(start[:2], controller.root[:2])


@pytest.mark.parametrize("command", sampled([*AWAY, *DIRECTIONS], 4))
def test_who_stands_hard_by_an_obstacle_walks_away_from_it(command: Command) -> None:
    controller = Controller(AVATAR, Scene.load("c"), seed=2, start=HARD_BY)
    assert moved(controller, command, 4.0) > 0.5


@pytest.mark.parametrize(("scene", "x", "z"), [("d", 0.064, 2.351), ("doorway", 0.08, 1.87)])
def test_who_has_no_room_for_a_stride_steps_back_and_goes_on(scene: str, x: float, z: float) -> None:
    """Before a sideboard's corner, and before a door of 0.4 m with no room to turn one's shoulder."""
    controller = Controller(AVATAR, Scene.load(scene), start=RootState(x, z))
    assert moved(controller, Command(forward=1.0), 5.0) > 1.0
    assert controller.root.z > z + 1.0


@pytest.mark.parametrize("direction", [-0.1, -0.06])
def test_who_stands_before_a_doorpost_in_mid_stride_gets_through_beside_it(direction: float) -> None:
    """Reached by the mouse: of the steps from here that were tried, the only free ones led 3 cm aside."""
    start = RootState(0.19383370394519506, 1.878, -0.09219500975227793, phase=2.4809562816133006)
    controller = Controller(AVATAR, Scene.load("doorway"), start=start)
    assert moved(controller, Command(forward=1.0, direction=direction), 14.0) > 1.0
    assert controller.root.z > 3.0


def test_whose_limbs_find_no_way_on_steps_to_where_they_do() -> None:
    """The legs could turn on the spot and go, but not the arms with them."""
    controller = Controller(AVATAR, Scene.load("d"), start=RootState(0.064, 2.351))
    assert moved(controller, Command(forward=1.0, direction=math.radians(210.0)), 5.0) > 0.5


def test_who_pushes_against_a_wall_stands() -> None:
    """No step leads on: it does not dance."""
    wall = [{"type": "box", "center": [0.0, 1.1, 1.0], "size": [8.0, 2.2, 0.2]}]
    scene = Scene.from_dict({**Scene.load("empty").to_dict(), "obstacles": wall})
    controller = Controller(AVATAR, scene, start=RootState(0.0, 0.3))
    moved(controller, Command(forward=1.0), 4.0)
    assert moved(controller, Command(forward=1.0), 3.0) < 0.02


class Ends:
    """Where random steering ends in a place, and whether it can be left from there in a direction that is free."""

    def __init__(self, place: Scene, seed: int) -> None:
        self._rng, self._check = np.random.default_rng(seed), BodyCheck(AVATAR, place)
        self._middles = np.array([center for _, _, center, _ in place.obstacles])[:, [0, 2]]
        self.controller = Controller(AVATAR, place, seed=seed)

    def steer(self) -> None:
        """Hold keys at random for a while, then mostly walk at something near, then stand."""
        for _ in range(3):
            strafe, forward = self._rng.choice([-1.0, 0.0, 1.0]), self._rng.choice([0.5, 1.0, 1.0, -1.0])
            turn = float(self._rng.choice([-0.6, 0.0, 0.0, 0.6]))
            moved(self.controller, Command(forward=float(forward), strafe=float(strafe), turn=turn), 1.5)
        apart = self._middles - np.array(self.controller.root[:2])
        near = apart[np.hypot(*apart.T) < 3.5]
        if len(near) and self._rng.random() < 0.8:
            x, z = near[self._rng.integers(len(near))]
            at_it = math.atan2(x, z) + float(self._rng.normal(0.0, 0.25))
            moved(self.controller, Command(forward=1.0, direction=at_it), 2.5)
        moved(self.controller, Command(), 1.2)

    def free(self) -> list[float]:
        """Those of twelve directions, from the heading, in which the body as it stands has half a metre."""
        shown = self.controller.step(Command(), 0.0)
        return [k * math.pi / 6 for k in range(12) if self._slides(shown, k * math.pi / 6)]

    def _slides(self, shown: Frame, aside: float) -> bool:
        root, way = shown.root.copy(), shown.root[2] + aside
        for _ in range(25):
            root[:2] += 0.02 * np.array([math.sin(way), math.cos(way)])
            if self._check.clearance(root, shown.q[3:], 0.0) < 0.012:
                return False
        return True

    def is_left(self, aside: float) -> bool:
        """Whether a direction that is asked for, in the world or as keys do, moves it by a quarter of a metre."""
        heading, keys = self.controller.root.heading, Command(forward=math.cos(aside), strafe=math.sin(aside))
        command = keys if self._rng.random() < 0.5 else Command(forward=1.0, direction=heading + aside)
        return moved(self.controller, command, 3.0) > 0.25

    def pick(self, free: list[float]) -> float:
        """One of some directions."""
        return free[int(self._rng.integers(len(free)))]


@pytest.mark.long
@pytest.mark.parametrize("scene", ["c", "d", "doorway", "level 4", "level 5"])
def test_wherever_steering_leads_there_is_a_way_on(scene: str) -> None:
    """Sixty ends: nobody is trapped (moves in no direction), few do not follow a free one that is asked for."""
    tried, refused, trapped = 0, 0, 0
    for seed in range(15):
        place = course(int(scene[-1]), seed % 7).scene if scene.startswith("level") else Scene.load(scene)
        ends = Ends(place, seed)
        for _ in range(4):
            ends.steer()
            free = ends.free()
            if not free:
                continue
            tried += 1
            if not ends.is_left(ends.pick(free)):
                refused += 1
                trapped += not any(ends.is_left(k * math.pi / 6) for k in range(12))
    print(f"{scene}: of {tried} ends with a free direction {refused} were not left in it, {trapped} in none")
    assert tried > 20
    assert trapped == 0
    assert refused <= 0.05 * tried
