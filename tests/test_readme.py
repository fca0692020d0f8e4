"""The Python of the README and of docs/planner.md runs as it stands, and the commands exist."""

import re
from pathlib import Path

from typer.main import get_command

from elbowroom.cli.main import app

ROOT = Path(__file__).parents[1]


def code_blocks(language: str, file: str = "README.md") -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", (ROOT / file).read_text("utf-8"), flags=re.DOTALL)


def test_python_example_runs(capsys) -> None:  # type: ignore[no-untyped-def]
    (example,) = code_blocks("python")
    exec(compile(example, "README.md", "exec"), {})
    assert "elbow room" in capsys.readouterr().out


def test_two_avatars_in_the_planners_page_pass_each_other(capsys) -> None:  # type: ignore[no-untyped-def]
    (example,) = code_blocks("python", "docs/planner.md")
    exec(compile(example, "docs/planner.md", "exec"), {})
    assert "past each other" in capsys.readouterr().out


def test_every_command_shown_is_a_command() -> None:
    commands = set(get_command(app).commands)  # type: ignore[attr-defined]
    shown = set(re.findall(r"^elbowroom (\w+)", "\n".join(code_blocks("bash")), flags=re.MULTILINE))
    assert shown == commands


def test_every_make_target_shown_exists() -> None:
    makefile = (ROOT / "Makefile").read_text()
    for target in re.findall(r"make (\w+)", " ".join(code_blocks("bash"))):
        assert re.search(rf"^{target}:", makefile, flags=re.MULTILINE), target
