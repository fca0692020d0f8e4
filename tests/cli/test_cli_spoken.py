"""Commands speak English and Traditional Chinese: no text is missing, and none is said with other values."""

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

import elbowroom.cli
from elbowroom.cli.telling.chinese import CHINESE
from elbowroom.cli.telling.spoken import said

SOURCES = sorted(Path(elbowroom.cli.__file__).parent.glob("*.py"))


def _texts(source: Path) -> set[str]:
    """What a module says: the first argument of `said`, there or in a constant of the module."""
    tree = ast.parse(source.read_text("utf-8"))
    named = {
        target.id: node.value.value
        for node in tree.body
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant)
        for target in node.targets
        if isinstance(target, ast.Name)
    }
    calls = (node for node in ast.walk(tree) if isinstance(node, ast.Call) and isinstance(node.func, ast.Name))
    firsts = [call.args[0] for call in calls if isinstance(call.func, ast.Name) and call.func.id == "said"]
    words = [one.value for one in firsts if isinstance(one, ast.Constant)]
    return {
        str(word)
        for word in [*words, *(named[one.id] for one in firsts if isinstance(one, ast.Name) and one.id in named)]
    }


def test_no_text_is_missing() -> None:
    texts = set().union(*map(_texts, SOURCES))
    assert len(texts) > 25
    assert sorted(texts - CHINESE.keys()) == []


def test_every_text_has_the_same_values() -> None:
    for english, chinese in CHINESE.items():
        assert sorted(re.findall(r"{\d}", english)) == sorted(re.findall(r"{\d}", chinese)), english
        assert re.search(r"[\u4e00-\u9fff]", chinese) or english.startswith("{0}: {1} of"), english


@pytest.mark.parametrize(
    ("environment", "expected"),
    [
        ({"LANG": "zh_TW.UTF-8"}, "是"),
        ({"LANG": "zh_TW.UTF-8", "LC_ALL": "en_US.UTF-8"}, "yes"),
        ({"LANG": "en_US.UTF-8", "ELBOWROOM_LANG": "zh-Hant"}, "是"),
        ({}, "yes"),
    ],
)
def test_the_environment_chooses(environment: dict[str, str], expected: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("ELBOWROOM_LANG", "LC_ALL", "LC_MESSAGES", "LANG"):
        monkeypatch.delenv(name, raising=False)
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    assert said("yes") == expected
    assert said("what nobody translated") == "what nobody translated"


def test_a_command_answers_in_chinese(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ELBOWROOM_LANG", "zh-Hant")
    call = [sys.executable, "-m", "elbowroom", "export", "--scene", "d", "-o", str(tmp_path / "d.glb"), "--quiet"]
    done = subprocess.run(call, capture_output=True, text=True, encoding="utf-8", check=True, timeout=600)
    assert "格式" in done.stdout
    assert "障礙物" in done.stdout
    assert "size" not in done.stdout
