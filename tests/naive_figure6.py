"""The paper's Figure 6 line by line, in plain Python: the twin that the compiled search must equal."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

Configuration = tuple[float, ...]


def squared_distance(a: Configuration, b: Configuration) -> float:
    total = 0.0
    for x, y in zip(a, b, strict=True):
        total += (x - y) * (x - y)
    return total


@dataclass
class NaiveGraph:
    """Vertices by number with their edges; numbers below `capacity` belong to the graph, others are visitors."""

    vertices: dict[int, Configuration]
    radius: float
    capacity: int
    chain: dict[int, int] = field(default_factory=dict)  # way stations: visitor -> next visitor

    def own(self) -> list[int]:
        return sorted(v for v in self.vertices if v < self.capacity)

    def ctn(self, vertex: int) -> list[int]:
        """The vertex itself, its neighbours by age, then the next way station."""
        here = self.vertices[vertex]
        near = [
            v for v in self.own() if v != vertex and math.sqrt(squared_distance(self.vertices[v], here)) < self.radius
        ]
        return [vertex, *near, *([self.chain[vertex]] if vertex in self.chain else [])]

    def enhance(self, configuration: Configuration) -> int:
        for v in self.own():
            if squared_distance(self.vertices[v], configuration) < 1e-12:
                return v
        new = len(self.own())
        self.vertices[new] = configuration
        return new


class Xorshift:
    def __init__(self, seed: int) -> None:
        self.x = seed

    def uniform(self) -> float:
        self.x ^= (self.x << 13) % 2**64
        self.x ^= self.x >> 7
        self.x ^= (self.x << 17) % 2**64
        return (self.x >> 11) * 2.0**-52 - 1.0


def sample_neighbor(
    here: Configuration, radius: float, limits: Sequence[Sequence[float]], elevation: float, chance: Xorshift
) -> Configuration:
    while True:
        step = [chance.uniform() if low < high else 0.0 for low, high in limits]
        if squared_distance(tuple(step), (0.0,) * len(step)) < 1.0:
            break
    new = [
        min(max(h + radius * (1.0 - 1e-9) * s, low), high) for h, s, (low, high) in zip(here, step, limits, strict=True)
    ]
    swing = math.sqrt(new[0] * new[0] + new[1] * new[1])
    if swing > elevation:
        new[0], new[1] = new[0] * (elevation / swing), new[1] * (elevation / swing)
    return tuple(new)


@dataclass
class NaiveResult:
    status: str
    path: list[int]
    checks: int = 0
    nodes: int = 0


class OutOfChecksError(Exception):
    pass


def search(
    graph: NaiveGraph,
    source: int,
    goals: Sequence[Configuration],
    collides: Callable[[Configuration, int, int], bool],
    search_new_neighbor: Callable[[Configuration], Configuration],
    budget: int,
) -> NaiveResult:
    """`collides(configuration, vertex, depth)`; `vertex` is -1 for one that is not in the graph yet."""
    result = NaiveResult("EXHAUSTED", [])
    n = len(goals) - 1

    def checked(configuration: Configuration, vertex: int, depth: int) -> bool:
        if result.checks == budget:
            raise OutOfChecksError
        result.checks += 1
        return collides(configuration, vertex, depth)

    path = [-1] * (n + 1)  # 1
    stack: list[tuple[int, int]] = []  # 2
    stack.append((source, 0))  # 6
    try:
        while stack:  # 7
            target, depth = stack.pop()  # 8
            result.nodes += 1
            path[depth] = target  # 9
            if depth == n:  # 10
                result.status, result.path = "FOUND", path
                return result  # 11
            t = depth + 1  # 12
            desire = goals[t]  # 13
            following = graph.ctn(target)  # 14
            following.sort(key=lambda v: squared_distance(graph.vertices[v], desire))  # 15: the last is the farthest
            count = 0  # 16
            while following:  # 17
                candidate = following.pop()  # 18
                if not checked(graph.vertices[candidate], candidate, t):  # 19
                    count += 1  # 20
                    stack.append((candidate, t))  # 21
            if count == 0 and len(graph.own()) < graph.capacity:  # 24
                new_node = search_new_neighbor(graph.vertices[target])  # 25
                if not checked(new_node, -1, t):  # 26
                    stack.append((graph.enhance(new_node), t))  # 27, 28
    except OutOfChecksError:
        result.status = "OUT_OF_BUDGET"
    return result  # 32
