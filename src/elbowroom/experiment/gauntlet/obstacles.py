"""What stands in the way: shapes that are pushed towards the line of a course until they nearly touch."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from elbowroom.experiment.gauntlet import levels
from elbowroom.experiment.gauntlet.draw import GRAIN, Draw
from elbowroom.experiment.gauntlet.motion import Passage

Floats = NDArray[np.float64]
Offset = tuple[float, float, float]

_HEAD_START = 0.15  # metres that a beam is further ahead: bent people's heads are there before their feet
_FAR = 1.3  # metres from the line where pushing starts
_ARMS_ALONE = (levels.ONE_ARM, levels.BOTH_ARMS)  # the trunk stays: only what is low can come nearer than the arms hang
_LOW_BOARDS = ((0.4, 0.95), (0.6, 1.0), (0.0, 0.9), (0.6, 1.2))  # lowest and highest point, metres
_BOARDS = ((1.0, 1.9), (0.6, 1.2), (0.0, 1.0), (0.8, 1.6))
_RAILS = ((0.6, 1.0), (0.8, 1.3), (1.1, 1.7))
_HIGH = 2.5  # metres above the ground where lowering starts


@dataclass(frozen=True)
class Proposal:
    """A box somewhere outside, and the direction in which it is pushed.

    To the left, up, ahead of the middle of the passage; metres, radians.
    """

    name: str
    size: Offset
    turn: Offset  # about the box's own X, Y and Z, in the order "YXZ", beyond the line's heading
    begin: Offset  # centre
    push: Offset  # unit vector

    def scaled(self, scale: float, long: bool) -> "Proposal":
        """The same for a body so many times as tall; what accompanies a long passage stays as long."""
        if scale == 1.0:  # exactly so for bodies of usual size
            return self
        x, y, z = (round(scale * side, GRAIN) for side in self.size)
        begin = tuple(round(scale * component, GRAIN) for component in self.begin)
        return replace(self, size=(x, y, self.size[2] if long else z), begin=(begin[0], begin[1], begin[2]))


def propose(draw: Draw, passage: Passage, first: bool) -> tuple[Proposal, ...]:
    """Obstacles that belong together, of a random kind that suits what the passage asks.

    The `first` ones of a long passage are as long as it is; where the body has to bend they come from above.
    """
    kinds = (_LONG if passage.long else _SHORT)[passage.asks]
    if first and not passage.long:
        kinds = _FIRST.get(passage.asks, kinds)
    if passage.long and not first:
        kinds += _SHORT[passage.asks]
    return draw.one_of(kinds)(draw, passage)


def _from_side(name: str, side: int, size: Offset, height: float, yaw: float, ahead: float) -> Proposal:
    """A box that comes from one side at a height (of its centre)."""
    begin = (side * (_FAR + 0.5 * size[0]), height, ahead)
    word = "left" if side > 0 else "right"
    return Proposal(f"{name}, {word}", size, (0.0, yaw, 0.0), begin, (-float(side), 0.0, 0.0))


def _ahead(draw: Draw, passage: Passage) -> float:
    """Somewhere in the middle half of the passage."""
    quarter = 0.25 * (passage.end - passage.begin)
    return draw.between((-quarter, quarter))


def _sides(passage: Passage, draw: Draw) -> int:
    return passage.side if passage.asks == levels.ONE_ARM else draw.sign()


def _post(draw: Draw, passage: Passage) -> tuple[Proposal, ...]:
    thick, deep = draw.between((0.06, 0.14)), draw.between((0.06, 0.14))
    tall = draw.between((0.7, 1.1) if passage.asks in _ARMS_ALONE else (1.2, 2.2))
    side, ahead, yaw = _sides(passage, draw), _ahead(draw, passage), draw.between((-0.7, 0.7))
    return (_from_side("post", side, (thick, tall, deep), 0.5 * tall, yaw, ahead),)


def _board(draw: Draw, passage: Passage) -> tuple[Proposal, ...]:
    side = _sides(passage, draw)
    return (_one_board(draw, passage, "board", side, _ahead(draw, passage)),)


def _one_board(draw: Draw, passage: Passage, name: str, side: int, ahead: float) -> Proposal:
    """A panel across the way: hanging, or a low one, or one as high as a man."""
    heights = _LOW_BOARDS if passage.asks in _ARMS_ALONE and draw.chance(0.8) else _BOARDS
    low, high = draw.one_of(heights)
    tall = draw.between((0.6 * (high - low), high - low))
    centre = round(draw.between((low, high - tall)) + 0.5 * tall, 3)
    size = (draw.between((0.3, 0.6)), tall, draw.between((0.04, 0.10)))
    return _from_side(name, side, size, centre, draw.between((-0.3, 0.3)), ahead)


def _gap(draw: Draw, passage: Passage) -> tuple[Proposal, ...]:
    """Two boards with a gap between them."""
    ahead = _ahead(draw, passage)
    return tuple(_one_board(draw, passage, "gap board", side, ahead) for side in (1, -1))


def _doorway(draw: Draw, passage: Passage) -> tuple[Proposal, ...]:
    """Two jambs, nearer to each other than the shoulders are wide; legs need more, so some begin above the hips."""
    low, top = draw.one_of((0.0, 1.08)), draw.between((1.9, 2.2))
    size = (draw.between((0.25, 0.45)), round(top - low, 3), draw.between((0.06, 0.14)))
    ahead, yaw = _ahead(draw, passage), draw.between((-0.15, 0.15))
    return tuple(_from_side("door jamb", side, size, round(0.5 * (low + top), 3), yaw, ahead) for side in (1, -1))


def _beam(draw: Draw, passage: Passage) -> tuple[Proposal, ...]:
    size = (draw.between((1.4, 2.2)), draw.between((0.08, 0.16)), draw.between((0.08, 0.16)))
    turn = (0.0, draw.between((-0.4, 0.4)), draw.between((-0.2, 0.2)))
    begin = (draw.between((-0.2, 0.2)), _HIGH, round(_ahead(draw, passage) + _HEAD_START, 3))
    return (Proposal("beam", size, turn, begin, (0.0, -1.0, 0.0)),)


def _tilted(draw: Draw, passage: Passage) -> tuple[Proposal, ...]:
    """A box askew, from the side or from above."""
    size = (draw.between((0.2, 0.5)), draw.between((0.2, 0.5)), draw.between((0.1, 0.4)))
    turn = (draw.between((-0.6, 0.6)), draw.between((-0.8, 0.8)), draw.between((-0.6, 0.6)))
    bends = passage.asks in (levels.BEND, levels.BEND_ARMS, levels.BEND_TWIST)
    rise = draw.between((0.5, 1.5) if bends and draw.chance(0.7) else (-0.1, 0.5))
    side, ahead = _sides(passage, draw), _ahead(draw, passage)
    height = draw.between((0.6, 1.0) if passage.asks in _ARMS_ALONE else (0.9, 1.4))
    across, up = side * float(np.cos(rise)), float(np.sin(rise))
    far = _FAR + 0.5
    begin = (round(far * across, 3), round(height + far * up, 3), ahead)
    return (Proposal("tilted box", size, turn, begin, (-across, -up, 0.0)),)


def _long_size(draw: Draw, passage: Passage) -> float:
    """Length of what accompanies a long passage: 3 m and more."""
    return draw.between((3.0, max(3.0, passage.end - passage.begin - 0.1)))


def _wall(draw: Draw, passage: Passage) -> tuple[Proposal, ...]:
    return (_one_wall(draw, passage, _sides(passage, draw), _long_size(draw, passage)),)


def _one_wall(draw: Draw, passage: Passage, side: int, length: float) -> Proposal:
    """A rail or shelf along the way, at the height of hands, elbows or shoulders."""
    low, high = draw.one_of(_LOW_BOARDS if passage.asks in _ARMS_ALONE else _RAILS)
    size = (draw.between((0.05, 0.30)), round(high - low, 3), length)
    return _from_side("rail", side, size, round(0.5 * (low + high), 3), 0.0, 0.0)


def _corridor(draw: Draw, passage: Passage) -> tuple[Proposal, ...]:
    length = _long_size(draw, passage)
    return tuple(_one_wall(draw, passage, side, length) for side in (1, -1))


def _ceiling(draw: Draw, passage: Passage) -> tuple[Proposal, ...]:
    size = (draw.between((1.0, 1.6)), draw.between((0.05, 0.15)), _long_size(draw, passage))
    turn = (0.0, 0.0, draw.between((-0.12, 0.12)))
    return (Proposal("ceiling", size, turn, (0.0, _HIGH, 0.0), (0.0, -1.0, 0.0)),)


Kind = Callable[[Draw, Passage], tuple[Proposal, ...]]

_SHORT: dict[str, tuple[Kind, ...]] = {
    levels.ONE_ARM: (_post, _board, _tilted),
    levels.BOTH_ARMS: (_gap, _gap, _board, _post, _tilted),
    levels.BEND: (_beam, _beam, _tilted),
    levels.TWIST: (_doorway, _doorway, _doorway, _gap),
    levels.BEND_ARMS: (_beam, _tilted, _board, _gap),
    levels.TWIST_ARMS: (_gap, _doorway, _gap, _tilted, _board),
    levels.BEND_TWIST: (_beam, _gap, _doorway, _tilted, _board),
}
_LONG: dict[str, tuple[Kind, ...]] = {
    levels.ONE_ARM: (_wall,),
    levels.BOTH_ARMS: (_corridor, _wall),
    levels.BEND: (_ceiling,),
    levels.TWIST: (_corridor, _wall),
    levels.BEND_ARMS: (_ceiling, _wall),
    levels.TWIST_ARMS: (_corridor, _wall),
    levels.BEND_TWIST: (_ceiling, _corridor, _wall),
}
_FIRST: dict[str, tuple[Kind, ...]] = {
    levels.BEND: (_beam, _beam, _tilted),
    levels.BEND_ARMS: (_beam,),
    levels.BEND_TWIST: (_beam,),
}
