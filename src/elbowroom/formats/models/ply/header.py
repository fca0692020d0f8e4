"""What the header of a PLY file says: how numbers are written, and the elements with their properties."""

import re
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

_HEADER = re.compile(rb"ply\r?\n.{0,65536}?\nend_header[ \t]*\r?\n", re.DOTALL)
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_KINDS = {
    **{"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"},
    **{"float": "f4", "double": "f8", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2"},
    **{"int32": "i4", "uint32": "u4", "float32": "f4", "float64": "f8"},
}
_CORNERS = ("vertex_index", "vertex_indices")
SIZE, CORNERS = "size", "corners"  # fields of the rows of faces


class Property(NamedTuple):
    """A property of an element."""

    name: str
    kind: str  # of NumPy
    counted: str = ""  # how the length of a list is written; empty: it is no list


@dataclass(frozen=True)
class Element:
    """A kind of element."""

    name: str
    count: int
    properties: tuple[Property, ...] = ()

    @property
    def lists(self) -> list[Property]:
        """Those of its properties that are lists."""
        return [each for each in self.properties if each.counted]

    def at(self, name: str) -> int:
        """The number of a property; raises ValueError."""
        return [each.name for each in self.properties].index(name)

    def row(self, order: str, corners: int = 0) -> np.dtype[np.void]:
        """How one is written in a binary file, its list with so many corners; other fields are called by numbers."""
        fields: list[tuple[str, str] | tuple[str, str, tuple[int]]] = []
        for number, each in enumerate(self.properties):
            if each.counted:
                fields += [(SIZE, order + each.counted), (CORNERS, order + each.kind, (corners,))]
            else:
                fields.append((str(number), order + each.kind))
        return np.dtype(fields)


class Header(NamedTuple):
    """A header."""

    text: bytes
    order: str  # of bytes, as NumPy has it; empty where the file is a text
    before: tuple[Element, ...]  # the faces
    faces: Element


def header_of(data: bytes) -> Header:
    """The header of a file whose faces have one list, of corners, and nothing before them any; raises ValueError."""
    found = _HEADER.match(data)
    if found is None:
        raise ValueError("no header")
    order, elements = "?", list[Element]()
    for line in found.group().decode("latin-1").splitlines():
        match line.split():
            case ["format", name, _]:
                order = _ORDERS[name]
            case ["element", name, count]:
                elements.append(Element(name, int(count)))
            case ["property", "list", counted, kind, name]:
                elements[-1] = _with(elements[-1], Property(name, _KINDS[kind], _KINDS[counted]))
            case ["property", kind, name]:
                elements[-1] = _with(elements[-1], Property(name, _KINDS[kind]))
    at = [element.name for element in elements].index("face")
    before, faces = tuple(elements[:at]), elements[at]
    (corners,) = faces.lists
    whole = "f" not in corners.kind + corners.counted
    if order == "?" or corners.name not in _CORNERS or not whole or any(element.lists for element in before):
        raise ValueError("faces are told in another way")
    if sum(element.count for element in (*before, faces)) > len(data) or min(each.count for each in elements) < 0:
        raise ValueError("more elements than bytes")
    return Header(found.group(), order, before, faces)


def _with(element: Element, one: Property) -> Element:
    return replace(element, properties=(*element.properties, one))
