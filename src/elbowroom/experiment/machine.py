"""What kind of machine this is, and which version of the program: what a measured number depends on."""

import hashlib
import platform
from functools import cache
from pathlib import Path

from elbowroom.experiment.parallel import usable_cores

_MEASURED = ("jit.py", "geometry", "body", "world", "planning", "control")
_IN_EXPERIMENT = ("crossing.py", "pacing.py", "scripted_user.py")


def machine_kind() -> str:
    """Processors and their widest vector unit, as "2 x86_64 cores with AVX-512, Linux"; no names of hosts."""
    from llvmlite.binding import get_host_cpu_features

    features = get_host_cpu_features()
    widths = {"avx512f": "AVX-512", "avx2": "AVX2", "avx": "AVX", "neon": "NEON"}
    vectors = next((f" with {name}" for feature, name in widths.items() if features.get(feature)), "")
    cores = usable_cores()
    return f"{cores} {platform.machine()} core{'s' * (cores > 1)}{vectors}, {platform.system()}"


@cache
def program_digest() -> str:
    """A hash of all code and data on which the outcome of a trial depends, besides scenes and avatars."""
    package = Path(__file__).parents[1]
    paths = [package / name for name in _MEASURED] + [package / "experiment" / name for name in _IN_EXPERIMENT]
    total = hashlib.sha256()
    for path in paths:
        for file in sorted(path.rglob("*")) if path.is_dir() else [path]:
            if file.suffix in (".py", ".json") and "scenes" not in file.parts:
                total.update(file.relative_to(package).as_posix().encode() + b"\0" + file.read_bytes())
    return total.hexdigest()
