"""What a command has no memory for is told in one line."""

import subprocess
import sys

_CALL = """
import sys

import numpy as np
import elbowroom.cli.main

def app(**_):
    np.empty(1 << 50, np.uint8)

commands = sys.modules["elbowroom.cli.main"]
commands.app = app
commands.run()
"""


def test_too_little_memory_is_told_in_one_line() -> None:
    run = subprocess.run([sys.executable, "-c", _CALL], capture_output=True, text=True, check=False)
    assert (run.returncode, len(run.stderr.splitlines())) == (2, 1), run.stderr
    assert run.stderr.startswith("elbowroom: there is too little memory for this (Unable to allocate 1.00 PiB")
