"""Which node is which bone, by the shape of the tree alone: hips that carry two legs, a trunk, two arms and a head.

Limbs are found as twins: brothers from which chains of equal lengths go out. The lowest twins are the legs, the
longest of the others the arms, and the way from the hips to the highest end is the trunk. Lengths do not depend on the
pose, so the figure need not stand in T-pose; it must only stand upright.
"""

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.bone_mapping.file_nodes import FileNodes
from elbowroom.body.bone_mapping.spelling import names_no_body, side_of

_MOST = 600  # joints that are looked at
_ALIKE = 0.12  # relative difference of lengths within twins
_LEVEL = 0.06  # difference in height of their roots, of the figure's height
_SHORTEST = 0.15  # of a limb, of the figure's height
_HANGING = 0.6  # how far down a leg reaches, of its length
_CLAVICLE = 0.75  # a first bone shorter than this part of the second is a clavicle
_TRUNK_TOP = 3  # nodes above the shoulders at which the last is a mere tip


@dataclass(frozen=True)
class _Twins:
    """Two chains of nodes that mirror each other, from the body outwards."""

    a: list[int]
    b: list[int]
    reach: float  # metres or whatever the file's unit is


class _Shape:
    """The tree of the nodes that can be body: joints of skins where there are any, without controls and ornaments."""

    def __init__(self, nodes: FileNodes) -> None:
        self.nodes = nodes
        body = [n for n in nodes.order if (not nodes.joints or n in nodes.joints) and not names_no_body(nodes.names[n])]
        self.body = body[:_MOST]
        known = set(self.body)
        above = {n: next((p for p in nodes.ancestors(n) if p in known), -1) for n in self.body}
        self.parents = above
        self.children: dict[int, list[int]] = {n: [] for n in [-1, *self.body]}
        for node in self.body:
            self.children[above[node]].append(node)
        heights = nodes.positions[self.body, 1] if self.body else np.zeros(1)
        self.height = max(float(np.ptp(heights)), 1e-9)
        self.reach = dict.fromkeys(self.body, 0.0)
        for node in reversed(self.body):
            if above[node] >= 0:
                self.reach[above[node]] = max(self.reach[above[node]], self.reach[node] + self.length(node))

    def at(self, node: int) -> NDArray[np.float64]:
        """Where a node is."""
        place: NDArray[np.float64] = self.nodes.positions[node]
        return place

    def length(self, node: int) -> float:
        """From a node to the one above it."""
        return float(np.linalg.norm(self.at(node) - self.at(self.parents[node])))

    def chain(self, node: int) -> list[int]:
        """From a node to its farthest end."""
        chain = [node]
        while self.children[chain[-1]]:
            chain.append(max(self.children[chain[-1]], key=lambda n: self.reach[n] + self.length(n)))
        return chain

    def way(self, top: int, node: int) -> list[int]:
        """The nodes from below `top` down to `node`."""
        way = []
        while node not in {top, -1}:
            way.append(node)
            node = self.parents[node]
        return way[::-1]

    def carrier(self, nodes: list[int]) -> int:
        """The lowest node that carries all of `nodes`; -1 for none."""
        ways = [self.way(-1, self.parents[node]) for node in nodes]
        return next((node for node in reversed(ways[0]) if all(node in way for way in ways)), -1)

    def below(self, node: int) -> set[int]:
        """A node and all that hang on it."""
        found = {node}
        for other in self.body:
            if self.parents[other] in found:
                found.add(other)
        return found

    def twins(self) -> list[_Twins]:
        """All pairs of brothers that carry chains of equal lengths."""
        found = []
        for brothers in self.children.values():
            for a, b in combinations(brothers[:12], 2):
                if self._are_twins(a, b):
                    found.append(_Twins(self.chain(a), self.chain(b), 0.5 * (self.reach[a] + self.reach[b])))
        return found

    def _are_twins(self, a: int, b: int) -> bool:
        long, short = max(self.reach[a], self.reach[b]), min(self.reach[a], self.reach[b])
        apart = np.abs(self.at(a) - self.at(b))
        if short < _SHORTEST * self.height or apart[1] > _LEVEL * self.height or max(apart[[0, 2]]) < 1e-6:
            return False
        bones = [
            abs(self.length(m) - self.length(n)) for m, n in zip(self.chain(a)[1:3], self.chain(b)[1:3], strict=False)
        ]
        return all(difference <= _ALIKE * long for difference in [long - short, *bones])


def bones_by_topology(nodes: FileNodes) -> dict[str, int]:
    """Bone -> node without spine and fingers; empty where no humanoid shape is found. Hands, feet and neck may lack."""
    shape = _Shape(nodes)
    twins = shape.twins()
    legs = _legs(shape, twins)
    arms = _arms(shape, twins, legs) if legs else None
    if legs is None or arms is None:
        return {}
    hips = shape.carrier([legs.a[0], legs.b[0], arms.a[0], arms.b[0]])
    if hips < 0:
        return {}
    bones = {"hips": hips} | _trunk(shape, hips, legs, arms)
    if "head" not in bones:
        return {}
    left = _left(shape, legs, arms)
    for pair, names in ((legs, _leg_bones), (arms, _arm_bones)):
        first = float((shape.at(pair.a[0]) - shape.at(pair.b[0])) @ left) > 0.0
        for side, chain in (("left", pair.a if first else pair.b), ("right", pair.b if first else pair.a)):
            bones |= {side + bone: node for bone, node in names(shape, chain).items()}
    return bones


def outer_end(nodes: FileNodes, node: int) -> int:
    """The next node of the limb beyond `node`, by the length that it carries; -1 for none."""
    shape = _Shape(nodes)
    chain = shape.chain(node) if node in shape.children else [node]
    return chain[1] if len(chain) > 1 else -1


def _legs(shape: _Shape, twins: list[_Twins]) -> _Twins | None:
    """The twins that hang down the lowest."""

    def end(pair: _Twins) -> float:
        return float(np.mean([shape.nodes.positions[chain, 1].min() for chain in (pair.a, pair.b)]))

    hanging = [
        pair
        for pair in twins
        if len(pair.a) > 1 and len(pair.b) > 1 and shape.at(pair.a[0])[1] - end(pair) > _HANGING * pair.reach
    ]
    lowest = min((end(pair) for pair in hanging), default=0.0)
    return max((p for p in hanging if end(p) < lowest + _LEVEL * shape.height), key=lambda p: p.reach, default=None)


def _arms(shape: _Shape, twins: list[_Twins], legs: _Twins) -> _Twins | None:
    """The longest twins that begin above the legs and are no part of them."""
    taken = shape.below(legs.a[0]) | shape.below(legs.b[0])
    high = shape.at(legs.a[0])[1]
    free = [
        pair
        for pair in twins
        if len(pair.a) > 1 and len(pair.b) > 1 and not taken & {pair.a[0], pair.b[0]} and shape.at(pair.a[0])[1] > high
    ]
    return max(free, key=lambda pair: pair.reach, default=None)


def _trunk(shape: _Shape, hips: int, legs: _Twins, arms: _Twins) -> dict[str, int]:
    """Neck and head: what is above the shoulders on the way from the hips to the highest end."""
    limbs = set().union(*(shape.below(chain[0]) for pair in (legs, arms) for chain in (pair.a, pair.b)))
    free = [n for n in shape.below(hips) - limbs - {hips} if not shape.below(n) & limbs]
    if not free:
        return {}
    way = shape.way(hips, max(free, key=lambda n: (float(shape.at(n)[1]), -n)))
    chest = shape.parents[arms.a[0]]
    if chest in way:
        top = way[way.index(chest) + 1 :]
    else:
        shoulders = float(shape.at(arms.a[0])[1])
        top = [n for n in way if shape.at(n)[1] > shoulders] or way[-1:]
    if not top:
        return {}
    if len(top) >= _TRUNK_TOP and not shape.children[top[-1]]:
        top = top[:-1]
    return {"head": top[-1]} | ({"neck": top[0]} if len(top) > 1 else {})


def _leg_bones(shape: _Shape, chain: list[int]) -> dict[str, int]:
    """Upper leg, knee, ankle, toes; of a longer chain the knee is the joint nearest to half the way to the ankle."""
    if len(chain) <= 4:
        return dict(zip(("UpperLeg", "LowerLeg", "Foot", "Toes"), chain, strict=False))
    heights = shape.nodes.positions[chain, 1]
    ankle = int(np.argmax(heights < heights.min() + 0.25 * (heights[0] - heights.min())))
    ankle = max(ankle, 2)
    knee = 1 + int(np.argmin(np.abs(heights[1:ankle] - 0.5 * (heights[0] + heights[ankle]))))
    bones = {"UpperLeg": chain[0], "LowerLeg": chain[knee], "Foot": chain[ankle]}
    return bones | ({"Toes": chain[ankle + 1]} if ankle + 1 < len(chain) else {})


def _arm_bones(shape: _Shape, chain: list[int]) -> dict[str, int]:
    """Clavicle if the first bone is short, upper arm, elbow, wrist."""
    clavicle = len(chain) >= 4 and shape.length(chain[1]) < _CLAVICLE * shape.length(chain[2])
    names = ("Shoulder", "UpperArm", "LowerArm", "Hand") if clavicle else ("UpperArm", "LowerArm", "Hand")
    return dict(zip(names, chain, strict=False))


def _left(shape: _Shape, legs: _Twins, arms: _Twins) -> NDArray[np.float64]:
    """The direction of the figure's left: by the names of its limbs, else by where the toes point, else facing +Z."""
    names = shape.nodes.names
    for pair in (legs, arms):
        across = shape.at(pair.a[0]) - shape.at(pair.b[0])
        for a, b in zip(pair.a, pair.b, strict=False):
            sides = side_of(names[a]), side_of(names[b])
            if set(sides) == {"left", "right"}:
                return across if sides[0] == "left" else -across
    ahead = np.array([0.0, 0.0, 1.0])
    if len(legs.a) > 3 and len(legs.b) > 3:
        toes = sum((shape.at(chain[-1]) - shape.at(chain[2]) for chain in (legs.a, legs.b)), np.zeros(3))
        toes[1] = 0.0
        ahead = toes if np.linalg.norm(toes) > 0.02 * shape.height else ahead
    left: NDArray[np.float64] = np.cross([0.0, 1.0, 0.0], ahead)
    return left
