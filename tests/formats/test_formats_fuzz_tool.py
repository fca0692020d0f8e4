"""`make fuzz`: each reader in a bounded process of its own; here a few inputs for two small readers."""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
TOOL = ROOT / "tools" / "fuzz_readers.py"

CRASH = """
import os
READERS["crash"] = lambda: Reader(lambda data: data == b"a good one" or os.kill(os.getpid(), 11), (b"a good one",))


if __name__ =="""


def fuzz(tool: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    path = os.pathsep.join([str(ROOT / "src"), str(ROOT / "tests")])
    command = [sys.executable, str(tool), *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False, env=os.environ | {"PYTHONPATH": path})


def test_small_readers_keep_their_promises() -> None:
    ran = fuzz(TOOL, "message", "bones", "--inputs", "200")
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert "message: 200 inputs" in ran.stdout
    assert "bones: 200 inputs" in ran.stdout
    assert "@" not in ran.stdout


def test_an_input_that_ends_its_reader_is_told_and_the_next_ones_go_on(tmp_path: Path) -> None:
    tool = tmp_path / "fuzz.py"
    tool.write_text(TOOL.read_text().replace("\nif __name__ ==", CRASH))
    ran = fuzz(tool, "crash", "--inputs", "3")
    assert ran.returncode == 1
    told = [line for line in ran.stdout.splitlines() if "ended its reader with -11" in line]
    assert [line.split(":")[1].split()[1] for line in told][:2] == ["0", "1"]
    assert "crash: 1 inputs" in ran.stdout  # the last one is a good one by chance
