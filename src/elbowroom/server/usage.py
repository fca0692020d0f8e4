"""What this process has cost so far."""

import os
import sys
import time
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Usage:
    """A reading; the difference of two is what happened between them."""

    wall_seconds: float
    cpu_seconds: float  # of all threads
    resident_bytes: int  # memory held now; its peak where the system does not tell the present value
    own_bytes: int  # the part of it that holds no file: as good as `resident_bytes` where the system does not tell


def process_usage() -> Usage:
    """Read the process's clocks and memory."""
    resident = _resident_bytes()
    return Usage(time.perf_counter(), time.process_time(), resident, _own_bytes(resident))


def _own_bytes(resident: int) -> int:
    """Without the libraries' files: how much of those lies in memory is the system's choice, differs from one machine
    to the next by tens of megabytes, and is shared between processes."""
    status = Path("/proc/self/status")
    lines = status.read_text().splitlines() if status.is_file() else []
    told = next((int(line.split()[1]) * 1024 for line in lines if line.startswith("RssAnon:")), resident)
    return min(told, resident)


def _resident_bytes() -> int:
    statm = Path("/proc/self/statm")
    if statm.is_file():
        return int(statm.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    import resource

    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else peak * 1024
