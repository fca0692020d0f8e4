"""Whether a dataset is whole, and whether its walks come out the same when they are walked again."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from elbowroom.dataset.manifest import Manifest, Written
from elbowroom.dataset.shards import Shard, read_shard, sha256, write_shard
from elbowroom.dataset.walk import WalkTask
from elbowroom.errors import InputError
from elbowroom.experiment.parallel import Workers


class Checked(NamedTuple):
    """What came of it."""

    files: int
    walks: int  # that are there
    walked: int  # that were walked again
    faults: tuple[str, ...]  # one line each


def check_dataset(
    folder: Path, workers: Workers, sample: int, tick: Callable[[int, int], None] = lambda _, __: None
) -> Checked:
    """Compare sums and columns of all files, and walk a sample again; raises `InputError` without a manifest."""
    manifest = Manifest.of(folder)
    faults: list[str] = []
    whole = [written for written in manifest.shards if _is_whole(folder, written, faults)]
    numbers = [int(n) for written in whole for n in read_shard(folder / written.file).column("walk").to_pylist()]
    if len(numbers) != sum(written.walks for written in whole):
        faults.append("the files hold another number of walks than the manifest says")
    rng = np.random.default_rng(len(numbers))
    chosen = sorted(rng.permutation(numbers)[:sample].tolist())
    tick(0, len(chosen))
    for done, (place, again) in enumerate(workers.run([WalkTask(manifest.spec, number) for number in chosen]), 1):
        faults.extend(_compared(folder, whole, chosen[place], again))
        tick(done, len(chosen))
    return Checked(len(manifest.shards), len(numbers), len(chosen), tuple(faults))


def _is_whole(folder: Path, written: Written, faults: list[str]) -> bool:
    path = folder / Path(written.file).name
    try:
        if sha256(path) != written.sha256:
            raise InputError(f"{path}: its SHA-256 is not that of the manifest")
        read_shard(path)
    except InputError as error:
        faults.append(str(error))
        return False
    return True


def _compared(folder: Path, whole: list[Written], number: int, again: Any) -> list[str]:
    """What differs between a walk as it lies there and as it was walked again, through the same file format."""
    if isinstance(again, str):
        return [f"walk {number}: walked again it is left out: {again}"]
    shard = next(one for one in whole if one.first <= number < one.end)
    table = read_shard(folder / shard.file)
    row = table.slice(table.column("walk").to_pylist().index(number), 1)
    path = folder / f".check-{number}"
    path.mkdir(exist_ok=True)
    try:
        write_shard(path, Shard(number, number + 1), [again])
        fresh = read_shard(path / Shard(number, number + 1).name)
    finally:
        for file in path.iterdir():
            file.unlink()
        path.rmdir()
    other = [name for name in table.column_names if not _same(row.column(name), fresh.column(name))]
    return [f"walk {number}: walked again, {', '.join(other)} differ"] if other else []


def _same(a: Any, b: Any) -> bool:
    """Bit for bit: what is no number equals itself."""
    one, other = a.combine_chunks(), b.combine_chunks()
    return bool(one.equals(other)) or _bytes(one) == _bytes(other)


def _bytes(array: Any) -> bytes:
    while hasattr(array, "flatten") and hasattr(array.type, "value_type"):
        array = array.flatten()
    return bytes(np.ascontiguousarray(array.to_numpy(zero_copy_only=False)).tobytes())
