"""The XML encoding of X3D (ISO/IEC 19776-1) as a node graph.

Read with expat's events: the document type is accepted and not fetched, what a file declares in it (entities, values
of attributes) is refused, and nothing outside the file is opened. Elements are nodes, attributes their fields.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NoReturn
from xml.parsers import expat

from elbowroom.errors import InputError
from elbowroom.formats.x3d.containers import default_field
from elbowroom.formats.x3d.model import (
    MAX_DEPTH,
    Attribute,
    Interface,
    Is,
    Node,
    Nodes,
    Notes,
    Route,
    Scope,
    Value,
    X3dScene,
)
from elbowroom.formats.x3d.numbers import NotNumbersError, parse_number, parse_strings

_MAX_ELEMENTS = 300_000
_OUTER = {"X3D", "Scene", "head", "Header", "ProtoInterface", "IS"}
_UNSEEN = {"IMPORT", "EXPORT", "component"}
_NO_FIELDS = {"DEF", "USE", "containerField", "class", "id", "style"}
_VALUED = {"initializeOnly", "inputOutput", "field", "exposedField", ""}


@dataclass(frozen=True, slots=True)
class _Place:
    """What an open element means for those inside it."""

    scope: Scope
    nodes: Nodes | None = None  # where nodes go that stand here; None: into the fields of `node`
    node: Node | None = None
    proto: Interface | None = None  # whose interface or body this is
    skipped: bool = False


def parse_xml(data: bytes, file: str, notes: Notes) -> X3dScene:
    """Read X3D in XML; raises `InputError` that names line and column."""
    return _Builder(file, notes).parse(data)


class _Builder:
    def __init__(self, file: str, notes: Notes) -> None:
        self._file, self._notes = file, notes
        scope = Scope()
        self._scene = X3dScene(file, [], scope.protos, named=scope.nodes)
        self._open = [_Place(scope, self._scene.roots)]
        self._elements = 0
        self._parser = expat.ParserCreate()
        self._parser.buffer_text = True
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._end
        self._parser.EntityDeclHandler = self._entity
        self._parser.StartDoctypeDeclHandler = self._doctype
        self._parser.SetParamEntityParsing(expat.XML_PARAM_ENTITY_PARSING_NEVER)

    def parse(self, data: bytes) -> X3dScene:
        try:
            self._parser.Parse(data, True)
        except expat.ExpatError as error:
            reason = expat.ErrorString(error.code)
            raise InputError(f"{self._file}: line {error.lineno}, column {error.offset + 1}: {reason}") from None
        except InputError:
            raise
        except (ValueError, LookupError):
            raise InputError(f"{self._file}: its text encoding is not known; save it as UTF-8") from None
        return self._scene

    def _entity(self, name: str, *_: object) -> NoReturn:
        raise InputError(f"{self._place()}: the entity {name[:40]!r} is declared: files with entities are not read")

    def _doctype(self, _name: str, _system: str | None, _public: str | None, has_own: int) -> None:
        if has_own:
            raise InputError(
                f"{self._place()}: the document type declares entities or values of its own ([...]); remove that"
            )

    def _place(self) -> str:
        return f"{self._file}: line {self._parser.CurrentLineNumber}"

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self._elements += 1
        if self._elements > _MAX_ELEMENTS:
            raise InputError(f"{self._file} has more than {_MAX_ELEMENTS} elements")
        if len(self._open) > 2 * MAX_DEPTH:
            raise InputError(f"{self._place()}: the elements are nested more than {2 * MAX_DEPTH} deep")
        if self._elements == 1 and tag != "X3D":
            raise InputError(f"{self._place()}: the first element is <{tag[:40]}>: a file in X3D begins with <X3D>")
        self._open.append(self._entered(self._open[-1], tag.rpartition(":")[2], attributes))

    def _end(self, _tag: str) -> None:
        place = self._open.pop()
        outer = self._open[-1]
        if place.node is not None and place.node is not outer.node and place.nodes is None and place.node.name:
            place.scope.nodes[place.node.name] = place.node

    def _entered(self, place: _Place, tag: str, attributes: dict[str, str]) -> _Place:
        """What the element means for those inside it."""
        if place.skipped or tag in _OUTER:
            return place
        if tag in _UNSEEN:
            return _Place(place.scope, skipped=True)
        if tag == "ProtoBody" and place.proto is not None:
            return _Place(place.scope, place.proto.body, proto=place.proto)
        reader = _READERS.get(tag, _Builder._node)
        return reader(self, place, tag, attributes)

    def _connect(self, place: _Place, _tag: str, attributes: dict[str, str]) -> _Place:
        if place.node is not None:
            place.node.fields[attributes.get("nodeField", "")] = Is(attributes.get("protoField", ""))
        return place

    def _meta(self, place: _Place, _tag: str, attributes: dict[str, str]) -> _Place:
        self._scene.meta.setdefault(attributes.get("name", "")[:100], attributes.get("content", "")[:1000])
        return place

    def _route(self, place: _Place, _tag: str, attributes: dict[str, str]) -> _Place:
        if place.scope.nodes is self._scene.named:
            ends = ("fromNode", "fromField", "toNode", "toField")
            self._scene.routes.append(Route(*(attributes.get(end, "") for end in ends)))
        return _Place(place.scope, skipped=True)

    def _extern(self, place: _Place, _tag: str, attributes: dict[str, str]) -> _Place:
        name = attributes.get("name", "")
        proto = Interface(name, {}, set(), [], parse_strings(attributes.get("url", "")))
        place.scope.protos[name] = proto
        return _Place(Scope(), proto=proto)

    def _declare(self, place: _Place, _tag: str, attributes: dict[str, str]) -> _Place:
        proto = Interface(attributes.get("name", ""), {}, set(), [], None)
        inner = place.scope.inside()
        place.scope.protos[proto.name] = proto
        return _Place(inner, proto=proto)

    def _field(self, place: _Place, tag: str, attributes: dict[str, str]) -> _Place:
        """The interface of a PROTO, a field of a Script, or the value that an instance of a PROTO gives a field."""
        name = attributes.get("name", "")
        fields: dict[str, Value] | None = None
        if tag == "fieldValue" and place.node is not None:
            fields = place.node.fields
        elif place.proto is not None and place.node is None:
            place.proto.fields.add(name)
            fields = place.proto.defaults if attributes.get("accessType", "") in _VALUED else None
        elif place.node is not None:
            fields = place.node.fields
        if fields is None:
            return _Place(place.scope, [])
        if "value" in attributes:
            fields[name] = Attribute(attributes["value"])
            return _Place(place.scope, [])
        nodes: Nodes = []
        if tag == "fieldValue" or place.proto is not None:
            fields[name] = nodes
        return _Place(place.scope, nodes)

    def _node(self, place: _Place, tag: str, attributes: dict[str, str]) -> _Place:
        kind = attributes.get("name", "") if tag == "ProtoInstance" else tag
        used = attributes.get("USE")
        if used is not None:
            node = place.scope.nodes.get(used)
            if node is None:
                self._notes.add(f"{self._place()}: USE {used[:40]} is left out: no node above it has this name")
                return _Place(place.scope, skipped=True)
            self._keep(place, node, tag, attributes)
            return _Place(place.scope, skipped=True)
        fields: dict[str, Value] = {
            key: Attribute(value)
            for key, value in attributes.items()
            if key not in _NO_FIELDS and not (tag == "ProtoInstance" and key == "name")
        }
        line = self._parser.CurrentLineNumber
        proto = place.scope.protos.get(kind) if tag == "ProtoInstance" else None
        node = Node(kind, self._file, line, attributes.get("DEF", ""), fields, proto)
        self._keep(place, node, tag, attributes)
        return _Place(place.scope, node=node)

    def _keep(self, place: _Place, node: Node, tag: str, attributes: dict[str, str]) -> None:
        """Put a node where its element stands."""
        if place.nodes is not None:
            place.nodes.append(node)
        elif place.node is not None:
            name = attributes.get("containerField") or default_field(
                node.kind if tag == "ProtoInstance" else tag, place.node.kind
            )
            present = place.node.fields.get(name)
            if not isinstance(present, list):
                present = []
                place.node.fields[name] = present
            present.append(node)

    def _unit(self, place: _Place, _tag: str, attributes: dict[str, str]) -> _Place:
        try:
            factor = parse_number(attributes.get("conversionFactor", "1").strip())
        except NotNumbersError as error:
            raise InputError(f"{self._place()}: conversionFactor: {error}") from None
        if 1e-9 < factor < 1e9:
            if attributes.get("category") == "length":
                self._scene.metre = factor
            if attributes.get("category") == "angle":
                self._scene.radian = factor
        return place


_READERS: dict[str, Callable[[_Builder, _Place, str, dict[str, str]], _Place]] = {
    "ProtoDeclare": _Builder._declare,
    "ExternProtoDeclare": _Builder._extern,
    "field": _Builder._field,
    "fieldValue": _Builder._field,
    "connect": _Builder._connect,
    "meta": _Builder._meta,
    "ROUTE": _Builder._route,
    "unit": _Builder._unit,
}
