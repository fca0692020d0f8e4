"""The walk in one piece against the same walk step by step."""

import numpy as np
import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.planning.command import Command
from elbowroom.planning.root.cost import prices_of, seconds_lost
from elbowroom.planning.root.legs.leg_check import LegCheck
from elbowroom.planning.root.legs.lower_body import LowerBody
from elbowroom.planning.root.legs.moving_legs import MovingAround
from elbowroom.planning.root.line.ahead import RouteFinder
from elbowroom.planning.root.line.line import new_line, wanted_speed
from elbowroom.planning.root.line.straight_walk import Outlook, Walker, straight_walk
from elbowroom.planning.root.motion import NONE_SLOW, MotionBounds
from elbowroom.planning.root.plan import RootPlanKind, RootPlannerSettings
from elbowroom.planning.root.query import Asked, RootQuery
from elbowroom.world.obstacles.tracks.moving import Moving
from elbowroom.world.scene import Scene

HORIZON, INTERVAL, SIGHT, REACH = 12, 0.15, 4.5, 9.0
SETTINGS, BOUNDS = RootPlannerSettings(), MotionBounds(2.5, 2.0, 3.0, 14.0)
STILL = Moving()


class Paths:
    """One body in a scene, asked both ways."""

    def __init__(self, scene: str) -> None:
        self.body = LowerBody(Humanoid.default(), Scene.load(scene).obstacles)
        self.check = LegCheck(self.body, BOUNDS, SETTINGS.skin, SETTINGS.spacing)
        self.routes = RouteFinder(SETTINGS, self.body)
        hull, boxes, grids = self.body.hull, self.body.boxes, self.body.grids
        self.walker = Walker(BOUNDS, self.routes.half, SETTINGS.skin, hull, boxes, grids, prices_of(SETTINGS))

    def agree(self, start: RootState, command: Command, pace: float) -> bool:
        """Whether nothing is near; if so, the query must say the same."""
        line, speed = new_line(start, command, SETTINGS.motion), wanted_speed(command, SETTINGS.motion)
        outlook, around = (
            Outlook(HORIZON, INTERVAL, SIGHT, REACH),
            MovingAround(self.body, STILL, 0.0, HORIZON, INTERVAL),
        )
        found = straight_walk(self.walker, start.as_array(), line, speed, pace, outlook, NONE_SLOW)
        asked = Asked(start, command, HORIZON, INTERVAL, 0.0)
        query = RootQuery(SETTINGS, self.check, self.routes, asked, REACH, around)
        answer = query.travelled(line, pace * speed, SIGHT)
        free, states, stands, lost, x, z = found
        if not free:
            return False
        kind = RootPlanKind.STOPPED if stands else RootPlanKind.STRAIGHT
        assert states.tobytes() == answer.states.tobytes()
        assert (kind, (x, z), False) == (answer.kind, answer.goal, answer.ends)
        assert query.checks == 0
        assert lost == seconds_lost(
            SETTINGS, line, speed, states, HORIZON * INTERVAL, ends=False, around=around, size=(0.3, 1.8)
        )
        return True


@pytest.mark.parametrize("scene", ["a", "d", "empty"])
def test_it_is_the_walk_that_a_query_finds(scene: str) -> None:
    paths, rng, free = Paths(scene), np.random.default_rng(3), 0
    for _ in range(150):
        start = RootState(*rng.uniform([-1.5, -3, -3, -0.7, -0.6, -2, 0], [1.5, 6, 3, 2, 0.6, 2, 1]).tolist())
        forward, strafe, direction = rng.uniform([0.0, -0.3, -3.0], [1.0, 0.3, 3.0]).tolist()
        command = Command(forward, strafe) if rng.random() < 0.5 else Command(forward, direction=direction)
        free += paths.agree(start, command, float(rng.choice([1.0, 0.6])))
    assert free > 20
    assert scene == "empty" or free < 150


def test_who_wants_to_go_nowhere_stands() -> None:
    paths = Paths("empty")
    assert paths.agree(RootState(), Command(forward=0.01), 1.0)
