"""The node graph of an X3D or VRML97 file, and how its fields are read.

Neither grammar needs to know which node has which fields: values are kept as they stand, and get their type from
whoever asks. That way unknown nodes, extensions and PROTOs are read like all others.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.x3d.numbers import NotNumbersError, parse_numbers, parse_strings

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

LARGEST = 1e6  # of any number that places something
MAX_DEPTH = 200  # how deep nodes may be nested
MAX_NOTES = 20
_MAX_INDEX = 2**31


@dataclass(frozen=True, slots=True)
class Attribute:
    """A field as an XML attribute: text, whose meaning depends on the field."""

    text: str


@dataclass(frozen=True, slots=True)
class Is:
    """A field that takes its value from the interface of the surrounding PROTO."""

    field: str


Nodes = list["Node"]
Value = Floats | tuple[str, ...] | Nodes | Attribute | Is


@dataclass(frozen=True, slots=True)
class Interface:
    """What a PROTO or EXTERNPROTO offers, and the nodes that it stands for."""

    name: str
    defaults: dict[str, Value]  # by field; events have none
    fields: set[str]  # all fields and events
    body: Nodes  # empty for an EXTERNPROTO
    urls: tuple[str, ...] | None  # None for a PROTO


@dataclass(eq=False, slots=True)
class Node:
    """One node: what kind, where it was written, and its fields as they stand."""

    kind: str
    file: str
    line: int
    name: str = ""  # DEF
    fields: dict[str, Value] = field(default_factory=dict)
    proto: Interface | None = None  # set for an instance of a PROTO

    @property
    def place(self) -> str:
        """For messages: file, line, kind and name."""
        return f"{self.file}: line {self.line}: {self.kind[:60]}{f' {self.name[:60]}' if self.name else ''}"

    def wrong(self, name: str, allowed: str) -> InputError:
        """The error that names the field and what is allowed there."""
        return InputError(f"{self.place}.{name} must be {allowed}")

    def has(self, name: str) -> bool:
        """Whether the file gives this field a value."""
        return name in self.fields and not isinstance(self.fields[name], Is)

    def numbers(self, name: str, largest: float = LARGEST) -> Floats:
        """All numbers (n,) of a field, none when it is missing."""
        value = self.fields.get(name)
        if isinstance(value, Attribute):
            try:
                value = parse_numbers(value.text)
            except NotNumbersError as error:
                raise InputError(f"{self.place}.{name}: {error}") from None
            self.fields[name] = value
        if value is None or isinstance(value, Is) or (isinstance(value, list | tuple) and not value):
            return np.zeros(0)
        if not isinstance(value, np.ndarray):
            raise self.wrong(name, "numbers")
        if len(value) and not float(np.abs(value).max()) <= largest:
            raise self.wrong(name, f"finite numbers of at most {largest:g}")
        return value

    def vector(self, name: str, default: Iterable[float]) -> Floats:
        """A vector of as many numbers as the default has."""
        standard = np.array(tuple(default), dtype=np.float64)
        values = self.numbers(name)
        if not len(values):
            return standard
        if len(values) != len(standard):
            raise self.wrong(name, f"{len(standard)} numbers, not {len(values)}")
        return values

    def number(self, name: str, default: float) -> float:
        """One number."""
        return float(self.vector(name, (default,))[0])

    def vectors(self, name: str, size: int) -> Floats:
        """A list (n, size) of vectors."""
        values = self.numbers(name)
        if len(values) % size:
            raise self.wrong(name, f"vectors of {size} numbers each, not {len(values)} numbers in all")
        return values.reshape(-1, size)

    def integers(self, name: str) -> Ints:
        """Whole numbers (n,)."""
        values = self.numbers(name, _MAX_INDEX)
        whole = values.astype(np.int64)
        if not np.array_equal(whole, values):
            raise self.wrong(name, "whole numbers")
        return whole

    def flag(self, name: str, default: bool) -> bool:
        """A boolean."""
        return bool(self.number(name, float(default)))

    def strings(self, name: str) -> tuple[str, ...]:
        """The texts of an MFString."""
        value = self.fields.get(name)
        if isinstance(value, Attribute):
            return parse_strings(value.text)
        return value if isinstance(value, tuple) else ()

    def text(self, name: str) -> str:
        """The text of an SFString, its white space folded, at most 200 characters of it."""
        value = self.fields.get(name)
        text = value.text if isinstance(value, Attribute) else " ".join(self.strings(name)[:1])
        return " ".join(text[:1000].split())[:200]

    def nodes(self, name: str) -> Nodes:
        """The nodes in a field."""
        value = self.fields.get(name)
        return value if isinstance(value, list) else []

    def node(self, name: str) -> "Node | None":
        """The node in an SFNode field."""
        nodes = self.nodes(name)
        return nodes[0] if nodes else None


@dataclass(eq=False)
class Notes:
    """What was left out in reading a file, one line each; only so many are kept."""

    lines: list[str] = field(default_factory=list)

    def add(self, line: str) -> None:
        """Keep a line that is not there yet."""
        if line not in self.lines and len(self.lines) < MAX_NOTES:
            self.lines.append(line)


@dataclass(frozen=True, slots=True)
class Route:
    """What one node says is told to another: DEF names and fields."""

    source: str
    output: str
    target: str
    input: str


@dataclass(eq=False)
class X3dScene:
    """A file as it was written: PROTOs not expanded, Inlines not read."""

    file: str
    roots: Nodes
    protos: dict[str, Interface]
    metre: float = 1.0  # metres per unit of length (the UNIT statement)
    radian: float = 1.0  # radians per unit of angle
    meta: dict[str, str] = field(default_factory=dict)  # of the header; the first of each name
    named: dict[str, Node] = field(default_factory=dict)  # by DEF name, outside of PROTOs
    routes: list[Route] = field(default_factory=list)  # outside of PROTOs


@dataclass(eq=False)
class Scope:
    """The names that are known at a place of a file: a PROTO's body has its own."""

    nodes: dict[str, Node] = field(default_factory=dict)
    protos: dict[str, Interface] = field(default_factory=dict)

    def inside(self) -> "Scope":
        """The scope of a PROTO declared here: its node names are its own, PROTOs of outside are known."""
        return Scope({}, dict(self.protos))
