"""Whether two compilations of the same sources made the same machine code: what a kernel computes must not hang on it.

Call: python tools/same_kernels.py FOLDER OTHER
Each folder is one that `NUMBA_CACHE_DIR=FOLDER elbowroom compile` has filled, in as many processes as there are
processors, or any program that compiles as it goes. Kernels that one of them alone has are left out. One whose
functions lie in another order differs too: that is of no consequence, and rare.
"""

import argparse
import pickle
import sys
from collections import Counter
from pathlib import Path

from llvmlite.binding import ObjectFileRef

Code = tuple[bytes, ...]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("other", type=Path)
    chosen = parser.parse_args()
    one, other = kernels(chosen.folder), kernels(chosen.other)
    both = sorted(one.keys() & other.keys())
    if not both:
        sys.exit(f"{chosen.folder} and {chosen.other} have no kernel in common: compile the same sources into both")
    told = [(kernel, difference(code(one[kernel]), code(other[kernel]))) for kernel in both]
    for (folder, kernel), differs in told:
        if differs:
            print(f"{folder}/{kernel}: {differs}")
    count = Counter(differs or "are the same" for _, differs in told)
    print(f"{len(both)} kernels in both: " + ", ".join(f"{n} {what}" for what, n in sorted(count.items())))
    sys.exit(1 if count["differ"] else 0)


def kernels(folder: Path) -> dict[tuple[str, str], list[Path]]:
    """The files of each kept kernel, one a signature, by their folder, which tells the sources, and their name."""
    found = sorted(folder.glob("*/*.nbi"))
    return {(index.parent.name, index.stem): sorted(index.parent.glob(f"{index.stem}.*.nbc")) for index in found}


def code(files: list[Path]) -> list[Code]:
    """What is executed, and the numbers that it reads: names lie elsewhere."""
    return sorted(machine_code(file) for file in files)


def machine_code(file: Path) -> Code:
    (_, _, (compiled, _)), *_ = pickle.loads(file.read_bytes())
    sections = ObjectFileRef.from_data(compiled).sections()
    read = (section for section in sections if section.is_text() or b".cst" in (section.name() or b""))
    return tuple(sorted(section.data() for section in read))


def difference(one: list[Code], other: list[Code]) -> str:
    """What is to be said of two compilations of a kernel; nothing where they are the same."""
    if len(one) != len(other):
        return "have other signatures"
    return "" if one == other else "differ"


if __name__ == "__main__":
    main()
