"""PROTOs, EXTERNPROTOs and Inlines put in place: a graph of plain nodes, of bounded size and depth."""

from elbowroom.errors import InputError
from elbowroom.formats.x3d.files import FilesBeside
from elbowroom.formats.x3d.model import MAX_DEPTH, Interface, Is, Node, Nodes, Value, X3dScene

MAX_NODES = 100_000

# H-Anim nodes stay themselves even where a file brings a PROTO for them; 1.x files call them by the short names.
_HANIM = {short: f"HAnim{short}" for short in ("Humanoid", "Joint", "Segment", "Site", "Displacer", "Motion")}
_NATIVE = frozenset(_HANIM.values())

_Fields = dict[str, Value]
_Seen = dict[int, Node]


def expand(scene: X3dScene, beside: FilesBeside) -> Nodes:
    """The roots of a scene with everything that stands for other nodes replaced by them.

    Nodes that the file shares (USE) are shared here too. Raises `InputError` when they become too many or too deep.
    """
    return _Expander(beside).nodes(scene.roots, None, {}, 0)


class _Expander:
    def __init__(self, beside: FilesBeside) -> None:
        self._beside = beside
        self._made = 0

    def nodes(self, nodes: Nodes, values: _Fields | None, seen: _Seen, depth: int) -> Nodes:
        found = []
        for node in nodes:
            expanded = self._node(node, values, seen, depth)
            if expanded is not None:
                found.append(expanded)
        return found

    def _node(self, node: Node, values: _Fields | None, seen: _Seen, depth: int) -> Node | None:
        """The plain node that stands for `node`, inside a PROTO whose interface has `values`; None for nothing."""
        if id(node) in seen:
            return seen[id(node)]
        self._made += 1
        if self._made > MAX_NODES:
            raise InputError(f"{node.place}: with its PROTOs and Inlines the file has more than {MAX_NODES} nodes")
        if depth > MAX_DEPTH:
            raise InputError(f"{node.place}: the nodes are nested more than {MAX_DEPTH} deep")
        kind = _native_kind(node)
        if kind is None and node.proto is not None:
            expanded = self._instance(node, node.proto, values, seen, depth)
        elif node.kind == "Inline":
            expanded = self._inline(node, values, depth)
        else:
            expanded = Node(kind or node.kind, node.file, node.line, node.name)
            if node.proto is not None:
                expanded.fields.update(self._fields(node.proto.defaults, None, {}, depth + 1))
            expanded.fields.update(self._fields(node.fields, values, seen, depth + 1))
        if expanded is not None:
            seen[id(node)] = expanded
        return expanded

    def _fields(self, fields: _Fields, values: _Fields | None, seen: _Seen, depth: int) -> _Fields:
        found: _Fields = {}
        for name, value in fields.items():
            if isinstance(value, Is):
                if values is not None and value.field in values:
                    found[name] = values[value.field]
            elif isinstance(value, list):
                found[name] = self.nodes(value, values, seen, depth)
            else:
                found[name] = value
        return found

    def _instance(self, node: Node, proto: Interface, values: _Fields | None, seen: _Seen, depth: int) -> Node | None:
        """The first node of a PROTO's body; those after it are not shown (ISO/IEC 19775-1, 4.4.4.3)."""
        declared = proto if proto.urls is None else self._beside.find_proto(proto, node)
        if declared is None or not declared.body:
            return None
        given = self._fields(node.fields, values, seen, depth + 1)
        inside = self._fields(declared.defaults, None, {}, depth + 1) | given
        first = self._node(declared.body[0], inside, {}, depth + 1)
        if first is not None and node.name:
            first.name = node.name
        return first

    def _inline(self, node: Node, values: _Fields | None, depth: int) -> Node | None:
        asked = Node(node.kind, node.file, node.line, node.name, self._fields(node.fields, values, {}, depth))
        scene = self._beside.open(asked.strings("url"), asked)
        if scene is None:
            return None
        group = Node("Group", node.file, node.line, node.name)
        group.fields["children"] = self.nodes(scene.roots, None, {}, depth + 1)
        return group


def _native_kind(node: Node) -> str | None:
    """The H-Anim node that this one is, whatever PROTO it comes from."""
    if node.kind in _NATIVE:
        return node.kind
    short = node.kind in _HANIM and node.proto is not None and "name" in node.proto.fields
    return _HANIM[node.kind] if short else None
