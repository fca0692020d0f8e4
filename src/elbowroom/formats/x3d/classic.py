"""The grammar of VRML97 (ISO/IEC 14772-1) and X3D Classic (ISO/IEC 19776-2) as a node graph.

The parser keeps its own stack, so that no nesting can overflow Python's. A node's DEF name is known from its closing
bracket on: USE can therefore never make a circle.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from elbowroom.errors import InputError
from elbowroom.formats.x3d.model import MAX_DEPTH, Interface, Is, Node, Nodes, Notes, Route, Scope, Value, X3dScene
from elbowroom.formats.x3d.tokens import Token, TokenKind, Tokens

_EVENTS = {"eventIn", "eventOut", "inputOnly", "outputOnly"}
_FIELDS = {"field", "exposedField", "initializeOnly", "inputOutput"}
_HEADER = {"PROFILE": 1, "COMPONENT": 1, "META": 2, "UNIT": 3}  # words that follow
_LINKS = {"ROUTE": 3, "IMPORT": 1, "EXPORT": 1}


@dataclass(frozen=True, slots=True)
class _Statements:
    """Where nodes, PROTOs and ROUTEs may stand: the file, or the body of a PROTO up to its bracket."""

    nodes: Nodes
    scope: Scope
    proto: Interface | None  # the PROTO whose body this is


@dataclass(frozen=True, slots=True)
class _Fields:
    """Inside the brackets of a node."""

    node: Node
    scope: Scope


@dataclass(frozen=True, slots=True)
class _List:
    """Inside a list of nodes."""

    nodes: Nodes
    scope: Scope


@dataclass(frozen=True, slots=True)
class _Declaration:
    """Inside the interface of a PROTO."""

    proto: Interface
    scope: Scope


_Open = _Statements | _Fields | _List | _Declaration


def parse_classic(text: str, file: str, notes: Notes) -> X3dScene:
    """Read VRML97 or X3D Classic; raises `InputError` that names line and column."""
    return _Parser(text, file, notes).parse()


class _Parser:
    def __init__(self, text: str, file: str, notes: Notes) -> None:
        self._tokens = Tokens(text, file)
        self._file, self._notes = file, notes
        self._scope = Scope()
        self._scene = X3dScene(file, [], self._scope.protos, named=self._scope.nodes)
        self._open: list[_Open] = [_Statements(self._scene.roots, self._scope, None)]

    def parse(self) -> X3dScene:
        while self._open:
            inside = self._open[-1]
            match inside:
                case _Statements():
                    self._statement(inside)
                case _Fields():
                    self._field(inside)
                case _List():
                    self._element(inside)
                case _Declaration():
                    self._declared(inside)
        return self._scene

    def _statement(self, inside: _Statements) -> None:
        token = self._tokens.next()
        ends = (
            token.kind is TokenKind.END if inside.proto is None else token.kind is TokenKind.SIGN and token.text == "}"
        )
        if ends:
            self._open.pop()
        elif token.kind is TokenKind.WORD and token.text in _HEADER and inside.proto is None:
            self._header(token.text)
        elif token.kind is TokenKind.WORD:
            if not self._is_declaration(token, inside.scope):
                self._node(token, inside.scope, inside.nodes.append)
        else:
            raise self._tokens.wrong(token, "a node" if inside.proto is None else "a node or '}'")

    def _field(self, inside: _Fields) -> None:
        token = self._tokens.next()
        if token.kind is TokenKind.SIGN and token.text == "}":
            self._open.pop()
            if inside.node.name:
                inside.scope.nodes[inside.node.name] = inside.node
        elif token.kind is not TokenKind.WORD:
            raise self._tokens.wrong(token, f"a field of {inside.node.kind[:40]} or '}}'")
        elif token.text in _EVENTS or token.text in _FIELDS:  # of a Script
            self._tokens.word("a type")
            name = self._tokens.word("a name")
            if token.text in _FIELDS or self._next_is("IS"):
                self._value(inside.node.fields, name, inside.scope)
        elif not self._is_declaration(token, inside.scope):
            self._value(inside.node.fields, token.text, inside.scope)

    def _element(self, inside: _List) -> None:
        token = self._tokens.next()
        if token.kind is TokenKind.SIGN and token.text == "]":
            self._open.pop()
        elif token.kind is TokenKind.WORD and token.text != "NULL":
            self._node(token, inside.scope, inside.nodes.append)
        elif token.kind is not TokenKind.WORD:
            raise self._tokens.wrong(token, "a node or ']'")

    def _declared(self, inside: _Declaration) -> None:
        token = self._tokens.next()
        if token.kind is TokenKind.SIGN and token.text == "]":
            self._tokens.sign("{", f"before the body of PROTO {inside.proto.name[:40]}")
            self._open[-1] = _Statements(inside.proto.body, inside.scope, inside.proto)
            return
        if token.text not in _EVENTS | _FIELDS:
            raise self._tokens.wrong(token, "field, exposedField, eventIn, eventOut or ']'")
        self._tokens.word("a type")
        name = self._tokens.word("a name")
        inside.proto.fields.add(name)
        if token.text in _FIELDS:
            self._value(inside.proto.defaults, name, inside.scope)

    def _value(self, fields: dict[str, Value], name: str, scope: Scope) -> None:
        """What follows a field's name."""
        token = self._tokens.peek()
        if token.kind is TokenKind.NUMBER:
            fields[name] = self._tokens.numbers()
            return
        self._tokens.next()
        if token.kind is TokenKind.TEXT:
            fields[name] = (token.text,)
        elif token.kind is TokenKind.SIGN and token.text == "[":
            self._list(fields, name, scope)
        elif token.kind is not TokenKind.WORD:
            raise self._tokens.wrong(token, f"a value of {name[:40]}")
        elif token.text == "IS":
            fields[name] = Is(self._tokens.word("the name of a field"))
        elif token.text in ("TRUE", "FALSE", "true", "false"):
            fields[name] = np.array([float(token.text.lower() == "true")])
        elif token.text == "NULL":
            fields[name] = []
        else:
            nodes: Nodes = []
            fields[name] = nodes
            self._node(token, scope, nodes.append)

    def _list(self, fields: dict[str, Value], name: str, scope: Scope) -> None:
        """What follows the `[` of a field."""
        numbers = self._tokens.number_list()
        if numbers is not None:
            fields[name] = numbers
            return
        token = self._tokens.peek()
        if token.kind is TokenKind.TEXT:
            fields[name] = self._texts()
        elif token.kind is TokenKind.NUMBER or token.text in ("TRUE", "FALSE", "true", "false"):
            fields[name] = self._booleans(token)
        else:
            nodes: Nodes = []
            fields[name] = nodes
            self._enter(_List(nodes, scope))

    def _texts(self) -> tuple[str, ...]:
        texts = []
        while (token := self._tokens.next()).kind is TokenKind.TEXT:
            texts.append(token.text)
        if token.kind is not TokenKind.SIGN or token.text != "]":
            raise self._tokens.wrong(token, "a text or ']'")
        return tuple(texts)

    def _booleans(self, first: Token) -> Value:
        """A list of TRUE and FALSE; numbers that get here stand among something else."""
        values = []
        while (token := self._tokens.next()).text in ("TRUE", "FALSE", "true", "false"):
            values.append(float(token.text.lower() == "true"))
        if token.kind is not TokenKind.SIGN or token.text != "]":
            raise self._tokens.wrong(
                token, "a number or ']'" if first.kind is TokenKind.NUMBER else "TRUE, FALSE or ']'"
            )
        return np.array(values)

    def _node(self, token: Token, scope: Scope, keep: Callable[[Node], None]) -> None:
        """A node, DEF or USE whose first word was just taken."""
        if token.text == "USE":
            self._use(token, scope, keep)
            return
        name = ""
        if token.text == "DEF":
            name = self._tokens.word("a name")
            token = self._tokens.next()
        if token.kind is not TokenKind.WORD:
            raise self._tokens.wrong(token, "a node")
        kind = token.text
        self._tokens.sign("{", f"after {kind[:40]}")
        node = Node(kind, self._file, self._tokens.line(token.start), name, {}, scope.protos.get(kind))
        keep(node)
        self._enter(_Fields(node, scope))

    def _use(self, token: Token, scope: Scope, keep: Callable[[Node], None]) -> None:
        name = self._tokens.word("a name")
        if name in scope.nodes:
            keep(scope.nodes[name])
        else:
            line = self._tokens.line(token.start)
            self._notes.add(f"{self._file}: line {line}: USE {name[:40]} is left out: no node above it has this name")

    def _enter(self, inside: _Open) -> None:
        if len(self._open) >= 2 * MAX_DEPTH:
            line = self._tokens.line(self._tokens.peek().start)
            raise InputError(f"{self._file}: line {line}: the nodes are nested more than {MAX_DEPTH} deep")
        self._open.append(inside)

    def _is_declaration(self, token: Token, scope: Scope) -> bool:
        """Whether a PROTO, EXTERNPROTO, ROUTE or the like begins at this token; if so, it is read."""
        if token.text in _LINKS:
            words = [self._tokens.word(f"the rest of the {token.text}") for _ in range(_LINKS[token.text])]
            if token.text == "ROUTE" and scope is self._scope:
                (source, _, output), (target, _, into) = words[0].partition("."), words[2].partition(".")
                self._scene.routes.append(Route(source, output, target, into))
            if token.text != "ROUTE" and self._next_is("AS"):
                self._tokens.next()
                self._tokens.word("a name")
        elif token.text == "PROTO":
            proto = Interface(self._tokens.word("a name"), {}, set(), [], None)
            self._tokens.sign("[", f"after PROTO {proto.name[:40]}")
            inner = scope.inside()
            scope.protos[proto.name] = proto
            self._enter(_Declaration(proto, inner))
        elif token.text == "EXTERNPROTO":
            self._extern(scope)
        else:
            return False
        return True

    def _extern(self, scope: Scope) -> None:
        name = self._tokens.word("a name")
        self._tokens.sign("[", f"after EXTERNPROTO {name[:40]}")
        fields = set()
        while (token := self._tokens.next()).text in _EVENTS | _FIELDS and token.kind is TokenKind.WORD:
            self._tokens.word("a type")
            fields.add(self._tokens.word("a name"))
        if token.kind is not TokenKind.SIGN or token.text != "]":
            raise self._tokens.wrong(token, "field, exposedField, eventIn, eventOut or ']'")
        token = self._tokens.next()
        if token.kind is TokenKind.TEXT:
            urls: tuple[str, ...] = (token.text,)
        elif token.kind is TokenKind.SIGN and token.text == "[":
            urls = self._texts()
        else:
            raise self._tokens.wrong(token, f"the URL of EXTERNPROTO {name[:40]}")
        scope.protos[name] = Interface(name, {}, fields, [], urls)

    def _header(self, word: str) -> None:
        found = [self._tokens.next() for _ in range(_HEADER[word])]
        for token in found:
            if token.kind in (TokenKind.SIGN, TokenKind.END):
                raise self._tokens.wrong(token, f"the rest of {word}")
        if word == "META":
            self._scene.meta.setdefault(found[0].text[:100], found[1].text[:1000])
        if word == "UNIT" and found[2].kind is TokenKind.NUMBER and 1e-9 < float(found[2].text) < 1e9:
            if found[0].text == "length":
                self._scene.metre = float(found[2].text)
            if found[0].text == "angle":
                self._scene.radian = float(found[2].text)

    def _next_is(self, word: str) -> bool:
        token = self._tokens.peek()
        return token.kind is TokenKind.WORD and token.text == word
