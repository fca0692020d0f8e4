"""Godot with a VMC add-on of others, as a receiver that judges what we send.

Neither comes with the tests: `godot` (4.4 or newer) lies in the PATH or in $ELBOWROOM_GODOT, and $ELBOWROOM_GODOT_VMC
names a checkout of github.com/Malcolmnixon/GodotXRVmcTracker (MIT), whose folder `addons/godot_vmc_tracker` is used.
"""

import json
import os
import shutil
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

HERE = Path(__file__).parent / "godot"
ADD_ON = Path("addons") / "godot_vmc_tracker"
_PROJECT = 'config_version=5\n[application]\nconfig/name="judge"\n'
_SECONDS = 120.0


class GodotJudge:
    """A project with the add-on in it."""

    def __init__(self, folder: Path) -> None:
        """Make it in an empty folder; skips where Godot or the add-on is not there."""
        named = os.environ.get("ELBOWROOM_GODOT") or shutil.which("godot") or shutil.which("godot4")
        checkout = os.environ.get("ELBOWROOM_GODOT_VMC")
        if named is None:
            pytest.skip("no Godot: install it, or name it in ELBOWROOM_GODOT")
        if checkout is None or not (Path(checkout) / ADD_ON).is_dir():
            pytest.skip("no VMC add-on: name a checkout of Malcolmnixon/GodotXRVmcTracker in ELBOWROOM_GODOT_VMC")
        self._godot, self._folder = named, folder
        shutil.copytree(Path(checkout) / ADD_ON, folder / ADD_ON)
        shutil.copy(HERE / "hear.gd", folder)
        (folder / "project.godot").write_text(_PROJECT)
        self._call("--import")  # finds the classes of the add-on

    def heard(self, port: int, send: Callable[[], object]) -> dict[str, Any]:
        """Godot's `version`, and `places` of joints by their Unity names, in its axes, while `send` is called again."""
        with self._open("--script", "res://hear.gd", "--", str(port)) as godot:
            assert godot.stdout is not None
            while "ready" not in (line := godot.stdout.readline()):
                assert line, "Godot ended"
            deadline = time.monotonic() + _SECONDS
            while godot.poll() is None and time.monotonic() < deadline:
                send()
                time.sleep(0.01)
            godot.kill()
            told = [line for line in godot.stdout.read().splitlines() if line.startswith("{")]
        answer: dict[str, Any] = json.loads(told[-1])
        return answer

    def _call(self, *arguments: str) -> None:
        with self._open(*arguments) as godot:
            godot.communicate(timeout=_SECONDS)

    def _open(self, *arguments: str) -> subprocess.Popen[str]:
        call = [self._godot, "--headless", "--path", str(self._folder), *arguments]
        return subprocess.Popen(call, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
