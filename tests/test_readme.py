"""What README, CONTRIBUTING and docs show can be done: Python runs, commands parse, targets and files exist."""

import json
import re
import shlex
from pathlib import Path
from typing import Any

import pytest
from typer.main import get_command

from elbowroom.cli.main import app
from elbowroom.world.scene import Scene

ROOT = Path(__file__).parents[1]


READMES = [ROOT / "README.md", ROOT / "README.zh-Hant.md"]
PAGES = [*READMES, ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]


def code_blocks(language: str, file: str = "README.md") -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", (ROOT / file).read_text("utf-8"), flags=re.DOTALL)


def code_lines(language: str, file: str) -> list[str]:
    return [line for block in code_blocks(language, file) for line in block.splitlines()]


def commands_in(page: Path) -> list[str]:
    """The calls of `elbowroom` in code blocks, indented lines and between backticks."""
    text = page.read_text("utf-8")
    blocks = re.findall(r"^(?: {4})?(elbowroom .*)$", text, flags=re.MULTILINE)
    return blocks + re.findall(r"`(elbowroom [^`\n]*)`", text)


def test_python_example_runs(capsys) -> None:  # type: ignore[no-untyped-def]
    (example,) = code_blocks("python")
    exec(compile(example, "README.md", "exec"), {})
    assert "elbow room" in capsys.readouterr().out


def test_two_avatars_in_the_planners_page_pass_each_other(capsys) -> None:  # type: ignore[no-untyped-def]
    (example,) = code_blocks("python", "docs/planner.md")
    exec(compile(example, "docs/planner.md", "exec"), {})
    assert "past each other" in capsys.readouterr().out


def test_the_scene_in_the_docs_is_a_scene() -> None:
    example = code_blocks("json", "docs/scenes.md")[0]
    assert Scene.from_dict(json.loads(example)).name == "attic"
    page = (ROOT / "docs" / "scenes.md").read_text("utf-8")
    assert [name for name in Scene.stock_names() if name not in "bc" and f"`{name}`" not in page] == []


def test_every_command_shown_is_a_command() -> None:
    commands = set(get_command(app).commands)  # type: ignore[attr-defined]
    shown = set(re.findall(r"^elbowroom (\w+)", "\n".join(code_blocks("bash")), flags=re.MULTILINE))
    assert shown == commands


def test_both_readmes_show_the_same_commands_programs_and_pictures() -> None:
    def said(page: Path) -> tuple[list[str], list[str], list[str]]:
        code = [line.partition("#")[0].rstrip() for name in ("bash", "python") for line in code_lines(name, page.name)]
        text = page.read_text("utf-8")
        return code, re.findall(r"!\[[^\]]*\]\(([^)]*)\)", text)[:1], re.findall(r"`(\.\w+|--?\w+)`", text)

    english, chinese = (said(page) for page in READMES)
    assert english == chinese
    assert "(README.zh-Hant.md)" in READMES[0].read_text("utf-8")
    assert "(README.md)" in READMES[1].read_text("utf-8")


def test_every_make_target_shown_exists() -> None:
    makefile = (ROOT / "Makefile").read_text()
    for page in PAGES:
        for targets in re.findall(r"(?:^|`)make ((?:[a-z-]+ ?)+)", page.read_text("utf-8"), flags=re.MULTILINE):
            for target in targets.split():
                assert re.search(rf"^{target}:", makefile, flags=re.MULTILINE), f"{page.name}: make {target}"


@pytest.mark.parametrize(("page", "command"), [(page.name, line) for page in PAGES for line in commands_in(page)])
def test_every_command_line_in_the_docs_is_understood(page: str, command: str) -> None:
    words = shlex.split(command, comments=True)[1:]
    called: Any = get_command(app)
    while hasattr(called, "commands"):
        first = words.pop(0) if words else ""
        if first.startswith("-") or not first:
            return  # `elbowroom --help`, `elbowroom bench`
        if first not in called.commands and hasattr(called, "default"):  # a group that may be called without its word
            words, first = [first, *words], called.default
        assert first in called.commands, command
        called = called.commands[first]
    if words:  # without, it is the command's name
        called.make_context(called.name, [word for word in words if word != "..."])


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_file_named_in_the_docs_exists(page: Path) -> None:
    for named in re.findall(r"`((?:src|tests|tools|docs|examples|web)/[\w./-]*)`", page.read_text("utf-8")):
        assert (ROOT / named).exists(), f"{page.name} names {named}"
