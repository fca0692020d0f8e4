"""`python -m elbowroom.server.apart BOUNDS JOB ARGUMENT...`: one job, its answer on standard output."""

import os
import sys
import traceback

from elbowroom.errors import InputError
from elbowroom.server.apart.answers import NO_SPACE, Outcome, packed
from elbowroom.server.apart.bounds import Bounds, end_with_parent, keep_to
from elbowroom.server.apart.jobs import JOBS

_TOLD = 4000  # characters of a traceback


def main(bounds: str, job: str, *arguments: str) -> tuple[Outcome, bytes]:
    """Do a job; how it went."""
    keep_to(Bounds.from_text(bounds))
    end_with_parent()
    try:
        return Outcome.MADE, packed(JOBS[job](*arguments))
    except InputError as error:
        return Outcome.WRONG, str(error).encode()
    except MemoryError:
        return Outcome.MEMORY, b""
    except OSError as error:
        if error.errno in NO_SPACE:
            return Outcome.DISK, b""
        return Outcome.FAILED, traceback.format_exc()[-_TOLD:].encode()
    except Exception:
        return Outcome.FAILED, traceback.format_exc()[-_TOLD:].encode()


if __name__ == "__main__":
    outcome, answer = main(*sys.argv[1:])
    with os.fdopen(1, "wb", closefd=False) as out:
        out.write(outcome.value)
        out.write(answer)
    os._exit(0)  # at once: without giving back a gigabyte piece by piece
