"""What is told to the user is told as it was said: no handler takes an `InputError` for another error of its kind."""

import ast
from pathlib import Path

import pytest

import elbowroom
from elbowroom.errors import InputError
from elbowroom.formats.file_bytes import read_file
from sources import nodes_of

SOURCES = Path(elbowroom.__file__).parent
WIDER = {error.__name__ for error in InputError.__mro__} - {"InputError", "object"}


def _named(tree: ast.AST | None) -> set[str]:
    return set() if tree is None else {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}


def _takes_what_it_raises(block: ast.Try) -> bool:
    """Whether an `InputError` that is raised in a block ends in one of its handlers that is meant for others."""
    raised = (node.exc for part in block.body for node in ast.walk(part) if isinstance(node, ast.Raise))
    if not any("InputError" in _named(error) for error in raised):
        return False
    first = next(
        (names for handler in block.handlers if (names := _named(handler.type)) & {"InputError", *WIDER}), None
    )
    return first is not None and "InputError" not in first


def test_no_block_takes_the_error_that_it_raises_for_another() -> None:
    blocks = [
        (path.relative_to(SOURCES), node.lineno)
        for path in SOURCES.rglob("*.py")
        for node in nodes_of(path)
        if isinstance(node, ast.Try) and _takes_what_it_raises(node)
    ]
    assert not blocks


def test_the_law_finds_one() -> None:
    wrong = "try:\n    raise InputError('large')\nexcept ValueError:\n    raise InputError('no name') from None"
    right = wrong.replace("except ValueError", "except InputError:\n    raise\nexcept ValueError")
    found = [
        _takes_what_it_raises(block) for text in (wrong, right) if isinstance(block := ast.parse(text).body[0], ast.Try)
    ]
    assert found == [True, False]


def test_a_file_that_is_too_large_gone_or_no_name_is_told_apart(tmp_path: Path) -> None:
    path = tmp_path / "big.glb"
    path.write_bytes(bytes(3 << 20))
    assert len(read_file(path, 3 << 20)) == 3 << 20
    for name, why in (
        (path, "big.glb: has 3 MB: at most 2 MB"),
        (tmp_path / "gone", "cannot be read: No such"),
        (tmp_path / "a\0b", "not a file name"),
    ):
        with pytest.raises(InputError, match=why):
            read_file(name, 2 << 20)
