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


def process_usage() -> Usage:
    """Read the process's clocks and memory."""
    return Usage(time.perf_counter(), time.process_time(), _resident_bytes())


def _resident_bytes() -> int:
    statm = Path("/proc/self/statm")
    if statm.is_file():
        return int(statm.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    import resource

    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else peak * 1024
