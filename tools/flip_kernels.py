"""Whether a damaged kernel on disk can do harm: one byte is flipped in each of many kept kernels, and a program is run.

Call: python tools/flip_kernels.py [--rounds 3] [--kernels 40] [--seed 1]
The kept kernels are copied first (compile them with `elbowroom compile`); the copies are damaged. In each round a walk
through scene D must end well, print what it prints with whole kernels, to the last bit, and say at most one line.
"""

import argparse
import os
import random
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from elbowroom.kernel_cache import PACKAGE, cache_folder, digest_of

KEPT = ("*.nbi", "*.nbc", "*.sum")
WALK = """
from elbowroom.body.humanoid import Humanoid
from elbowroom.control.controller import Controller
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene
controller = Controller(Humanoid.default(), Scene.load("d"))
frames = [controller.step(Command(forward=1.0), 1 / 60) for _ in range(240)]
print([number.hex() for number in frames[-1].q])
"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--kernels", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    chosen = parser.parse_args()
    chance, faults = random.Random(chosen.seed), 0
    with tempfile.TemporaryDirectory() as folder:
        cache = Path(folder)
        copied(cache)
        expected = walk(cache)
        if expected.returncode:
            sys.exit(f"the walk ends with {expected.returncode} on whole kernels: {expected.stderr.strip()}")
        for number in range(1, chosen.rounds + 1):
            flipped = flip(cache, chosen.kernels, chance)
            ran = walk(cache)
            same, said = ran.stdout == expected.stdout, len(ran.stderr.splitlines())
            faults += ran.returncode != 0 or not same or said > 1
            frames = "the same frames" if same else "OTHER FRAMES"
            print(f"round {number}: {flipped} kernels flipped, exit {ran.returncode}, {frames}, {said} lines said")
    sys.exit(f"{faults} rounds went wrong" if faults else 0)


def copied(cache: Path) -> None:
    """Copy the kept kernels of all sources to where `NUMBA_CACHE_DIR` has them."""
    for file in PACKAGE.rglob("*.py"):
        kept = cache_folder(file)
        names = sorted(path for kind in KEPT for path in kept.glob(f"{file.stem}.{kind}")) if kept is not None else []
        if names:
            into = cache / f"{file.stem}_{digest_of(file)[:32]}"
            into.mkdir(exist_ok=True)
            for path in names:
                shutil.copy(path, into)


def flip(cache: Path, count: int, chance: random.Random) -> int:
    """Flip a bit in each of so many files of kernels; how many there were."""
    files = sorted(path for path in cache.rglob("*.nb?") if path.stat().st_size)
    chosen = chance.sample(files, min(count, len(files)))
    for path in chosen:
        data = bytearray(path.read_bytes())
        data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
        path.write_bytes(data)
    return len(chosen)


def walk(cache: Path) -> subprocess.CompletedProcess[str]:
    """Walk by the kernels in a folder."""
    asked = [sys.executable, "-c", WALK]
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(cache)}
    return subprocess.run(asked, env=environment, capture_output=True, text=True, check=False)


if __name__ == "__main__":
    main()
