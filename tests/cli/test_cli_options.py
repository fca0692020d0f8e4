"""Options that several commands share: lists are written in one way, and every command shows examples."""

from pathlib import Path
from typing import Any

import pytest
from typer.main import get_command

from elbowroom.cli.main import app
from elbowroom.cli.options.lists import names_in, numbers_in, whole_numbers_in
from elbowroom.errors import InputError


def _commands(group: Any, name: str = "elbowroom") -> dict[str, Any]:
    inside = getattr(group, "commands", None)
    if inside is None:
        return {name: group}
    return {path: found for word, one in inside.items() for path, found in _commands(one, f"{name} {word}").items()}


COMMANDS = _commands(get_command(app))


@pytest.mark.parametrize("given", [["a,d"], ["a", "d"], [" a , d,"]])
def test_names_are_given_with_commas_or_one_by_one(given: list[str]) -> None:
    assert names_in(given) == ("a", "d")


def test_a_name_with_a_comma_in_it_stays_one(tmp_path: Path) -> None:
    file = tmp_path / "hall, attic.json"
    file.write_text("{}")
    assert names_in(["d, keys", str(file), "a,b"], whole=("d, keys",)) == ("d, keys", str(file), "a", "b")


def test_numbers_are_given_with_commas_or_one_by_one() -> None:
    assert whole_numbers_in("--queue", ["3,4", "7"], "3,5") == (3, 4, 7)
    assert numbers_in("--speed", ["0.8", "1.1,2"], "0.8") == (0.8, 1.1, 2.0)


@pytest.mark.parametrize("wrong", ["x", ",", "3,many", "3.5"])
def test_what_is_no_list_of_whole_numbers_is_told(wrong: str) -> None:
    with pytest.raises(InputError, match=f"--queue '{wrong}': whole numbers with commas between them, such as 3,5"):
        whole_numbers_in("--queue", [wrong], "3,5")


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_shows_examples_of_itself(name: str) -> None:
    examples = COMMANDS[name].epilog
    assert examples.startswith("Examples:  elbowroom ")
    assert name in examples or name.removesuffix(" make") in examples


@pytest.mark.parametrize("name", COMMANDS)
def test_an_option_that_takes_several_takes_them_by_either_name(name: str) -> None:
    for option in COMMANDS[name].params:
        plural = [word for word in option.opts if word.endswith("s") and word[:-1] in option.opts]
        assert option.multiple or not plural
