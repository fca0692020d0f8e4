"""Which node of a motion file is which bone."""

from collections.abc import Mapping

from elbowroom.body.bone_names import bones_by_name, checked_bones
from elbowroom.formats.nodes import NodeTree


def bones_of(tree: NodeTree, place: str, named: Mapping[str, int] | None = None) -> dict[str, int]:
    """The bones of a skeleton, parents first; `named` are those that the file itself names.

    Raises `InputError` where one that is needed is missing.
    """
    return checked_bones(named or bones_by_name(tree, ()), tree, place)[0]
