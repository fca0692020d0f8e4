"""Where the humanoid is in a scene, and what its node says."""

from collections.abc import Iterator

from elbowroom.errors import InputError
from elbowroom.formats.x3d.expand import MAX_NODES as MAX_VISITED
from elbowroom.formats.x3d.model import Node, Nodes, X3dScene
from elbowroom.formats.x3d.parts import shown_parts


def path_to_humanoid(roots: Nodes) -> Nodes:
    """The nodes from a root down to the first HAnimHumanoid, both included; empty if there is none."""
    waiting: list[tuple[Node, tuple[Node, ...]]] = [(node, ()) for node in reversed(roots)]
    seen: set[int] = set()
    while waiting:
        node, above = waiting.pop()
        if node.kind == "HAnimHumanoid":
            return [*above, node]
        if id(node) not in seen:
            seen.add(id(node))
            waiting += [(part, (*above, node)) for part in reversed(shown_parts(node))]
    return []


def skeleton_roots(humanoid: Node) -> Nodes:
    """What the skeleton of a humanoid begins with.

    Many files list every joint in `skeleton` once more, or instead of in `joints`: what hangs on another of the roots
    is no root.
    """
    roots = humanoid.nodes("skeleton") or humanoid.nodes("humanoidBody")
    inner: set[int] = set()
    waiting = [part for root in roots for part in shown_parts(root)]
    while waiting:
        node = waiting.pop()
        if id(node) not in inner:
            inner.add(id(node))
            waiting += shown_parts(node)
    seen: set[int] = set()
    found = []
    for root in roots:
        if id(root) not in inner | seen:
            seen.add(id(root))
            found.append(root)
    return found


def shapes_in(nodes: Nodes) -> Iterator[Node]:
    """All shapes that are shown of `nodes`; raises `InputError` for too many nodes."""
    waiting, visited = list(reversed(nodes)), 0
    while waiting:
        node = waiting.pop()
        visited += 1
        if visited > MAX_VISITED:
            raise InputError(f"{node.place}: the skin has more than {MAX_VISITED} nodes")
        if node.kind == "Shape":
            yield node
        waiting += reversed(shown_parts(node))


def coord_of(shape: Node) -> Node | None:
    """The Coordinate node of its geometry."""
    geometry = shape.node("geometry")
    return geometry.node("coord") if geometry else None


def is_centred(humanoid: Node | None) -> bool:
    """Whether the joints have their places by `center`, as H-Anim has it, and not by `translation`, as robots do."""
    waiting = humanoid.nodes("skeleton") or humanoid.nodes("humanoidBody") if humanoid else []
    waiting, visited = list(waiting), 0
    while waiting and visited < MAX_VISITED:
        node = waiting.pop()
        visited += 1
        if node.kind == "HAnimJoint" and node.vector("center", (0.0, 0.0, 0.0)).any():
            return True
        waiting += shown_parts(node)
    return False


def loa_of(humanoid: Node | None) -> int | None:
    """Its level of articulation, where it says one."""
    loa = int(humanoid.number("loa", -1.0)) if humanoid else -1
    return loa if 0 <= loa <= 4 else None


def info_of(scene: X3dScene, humanoid: Node | None) -> dict[str, str]:
    """The header's `meta` and the humanoid's `info`, which is written "key=value"."""
    info = dict(scene.meta)
    for line in humanoid.strings("info")[:100] if humanoid else ():
        key, equals, value = line.partition("=")
        if equals:
            info.setdefault(key.strip()[:100], " ".join(value.split())[:200])
    return info
