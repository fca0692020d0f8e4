"""One heap for all threads of a server, and what lasts in it."""

import gc
import platform
import subprocess
import sys

import numpy as np
import pytest

from elbowroom.cli.doctor.session_cost import memory_budget
from elbowroom.server.heap import HandingBack, settle, share_one_heap


def test_glibc_is_asked_for_one_heap_and_others_are_left_alone() -> None:
    assert share_one_heap() == (platform.libc_ver()[0] == "glibc")
    blocks = [np.ones(1000) for _ in range(1000)]
    del blocks
    try:
        assert isinstance(settle(), bool)
        assert gc.get_freeze_count() > 1000
    finally:
        gc.unfreeze()


def test_what_ended_sessions_have_freed_is_handed_back_while_others_go_on_but_seldom() -> None:
    now, handed = 0.0, list[float]()
    heap = HandingBack(lambda: now, lambda: handed.append(now))
    for step in range(600):  # a session ends every second, and one walks on for ten minutes
        now = float(step)
        heap.ended(1)
    assert 10 <= len(handed) <= 60
    assert np.diff(handed).min() >= 10.0
    before = len(handed)
    heap.ended(0)
    assert len(handed) == before + 1  # the last one leaves nothing behind


def test_the_budget_counts_the_process_once_and_every_session() -> None:
    one, four = memory_budget(1), memory_budget(4)
    assert one < four < 1.5 * one
    assert four - one == 3.0 * (memory_budget(2) - one)


@pytest.mark.long
def test_who_plays_in_a_stock_scene_does_not_pay_for_scipy() -> None:
    """It takes a tenth of the server's own memory, and only places made of triangles need it."""
    code = """
import sys
import elbowroom.server.app
from elbowroom.body.humanoid import Humanoid
from elbowroom.control.controller import Controller
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene
walk = Controller(Humanoid.default(), Scene.load("d"))
for _ in range(5):
    walk.step(Command(forward=1.0), 1 / 60)
large = {"scipy.ndimage", "scipy.sparse", "scipy.spatial", "scipy.stats", "scipy.signal"}
sys.exit(", ".join(sorted(large & set(sys.modules))) or 0)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
