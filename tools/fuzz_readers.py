"""Throws damaged files at the readers: each must answer with a result or one line, soon, and with bounded memory.

Call: python tools/fuzz_readers.py [READER ...] [--inputs 20000] [--seed 1] [--keep FOLDER]

Each reader runs in a process of its own, bounded as the server bounds its readers; should an input end that process,
it is told and the next ones go on in another. The readers are listed in `tests/fuzzed_readers.py`. The same seed throws
the same files. Exit code 1 if any input broke a promise; `--keep` saves those inputs.
"""

import argparse
import resource
import signal
import subprocess
import sys
import time
import warnings
from collections import Counter
from pathlib import Path
from types import FrameType
from typing import NoReturn

import numpy as np

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))

from elbowroom.server.apart.bounds import Bounds, keep_to
from fuzzed_readers import READERS
from fuzzing import Reader, answer, damaged

_GIVEN_UP = 20.0  # seconds of it after which it is stopped
MEMORY = 2**30  # bytes that the process of a reader may have


def run(name: str, inputs: range, seed: int, keep: Path | None) -> bool:
    """Fuzz one reader in this process and print a line of what it answered; True if it kept every promise.

    Before each input its number is printed, after an @.
    """
    reader = READERS[name]()
    for good in reader.seeds:
        answer(reader, good)  # compiled and warm; its time does not count
    warnings.simplefilter("error")  # who sent the file would see them
    keep_to(Bounds(memory=MEMORY, processor=10**6))
    answers: Counter[str] = Counter()
    slowest = 0.0
    for number in inputs:
        print(f"@{number}", flush=True)
        data = damaged(reader, np.random.default_rng([seed, number]))
        start = time.process_time()
        result = _watched(reader, data)
        took = time.process_time() - start
        slowest = max(slowest, took)
        if took > reader.longest:
            result = f"took {took:.1f} s"
        answers[result if result in {"read", "refused"} else "broken"] += 1
        if result not in {"read", "refused"}:
            _tell(name, number, seed, result, keep)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(
        f"{name}: {len(inputs)} inputs, {answers['read']} read, {answers['refused']} refused, "
        f"{answers['broken']} broken; slowest {slowest:.2f} s, process peak {peak:.0f} MB",
        flush=True,
    )
    return answers["broken"] == 0


def run_apart(name: str, inputs: int, seed: int, keep: Path | None) -> bool:
    """The same in a process of its own, and in another one where an input has ended it."""
    whole, number = True, -1
    while number + 1 < inputs:
        command = [sys.executable, __file__, name, "--inputs", str(inputs), "--seed", str(seed)]
        command += ["--inside", str(number + 1), *(["--keep", str(keep)] if keep else [])]
        number = -1
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
            assert process.stdout is not None
            for line in process.stdout:
                if line.startswith("@"):
                    number = int(line[1:])
                else:
                    print(line, end="", flush=True)
        if process.returncode in (0, 1) and (number + 1 == inputs):
            return whole and process.returncode == 0
        whole = False
        if number < 0:
            print(f"{name}: does not start (exit code {process.returncode})", flush=True)
            return False
        _tell(name, number, seed, f"ended its reader with {process.returncode}", None)
    return whole


def _tell(name: str, number: int, seed: int, result: str, keep: Path | None) -> None:
    print(f"{name}: input {number} of seed {seed}: {result}", flush=True)
    if keep is not None:
        keep.mkdir(parents=True, exist_ok=True)
        data = damaged(READERS[name](), np.random.default_rng([seed, number]))
        (keep / f"{name}-{seed}-{number}").write_bytes(data)


def _watched(reader: Reader, data: bytes) -> str:
    signal.signal(signal.SIGPROF, _stop)
    signal.setitimer(signal.ITIMER_PROF, _GIVEN_UP)
    try:
        return answer(reader, data)
    except Exception as error:
        return f"{type(error).__name__}: {' '.join(str(error).split())[:200]}"
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)


def _stop(_number: int, _frame: FrameType | None) -> NoReturn:
    raise TimeoutError(f"stopped after {_GIVEN_UP:.0f} s of processor time")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("readers", nargs="*", metavar="READER", help=f"of {', '.join(READERS)}; all if none is named")
    parser.add_argument("--inputs", type=int, default=20_000, help="of each reader")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, help="folder for the inputs that broke a promise")
    parser.add_argument("--inside", type=int, metavar="FIRST", help="in this process, from this input on")
    options = parser.parse_args()
    names = options.readers or list(READERS)
    unknown = sorted(set(names) - READERS.keys())
    if unknown:
        parser.error(f"no reader {', '.join(unknown)}; there are {', '.join(READERS)}")
    if options.inside is not None:
        kept = [run(name, range(options.inside, options.inputs), options.seed, options.keep) for name in names]
    else:
        kept = [run_apart(name, options.inputs, options.seed, options.keep) for name in names]
    sys.exit(0 if all(kept) else 1)


if __name__ == "__main__":
    main()
