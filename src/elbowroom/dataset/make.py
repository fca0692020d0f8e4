"""Making a dataset: walks that are not there yet, file by file, in whatever order they are done."""

from collections.abc import Callable
from dataclasses import asdict, replace
from pathlib import Path

from elbowroom.dataset.card import write_card
from elbowroom.dataset.in_use import in_use
from elbowroom.dataset.manifest import Manifest, Written
from elbowroom.dataset.row import Row
from elbowroom.dataset.shards import Shard, shards_of, write_shard
from elbowroom.dataset.spec import DatasetSpec
from elbowroom.dataset.walk import WalkTask
from elbowroom.errors import InputError
from elbowroom.experiment.parallel import Workers

Progress = Callable[[int, int], None]  # walks done, walks in all


def make_dataset(
    spec: DatasetSpec, folder: Path, workers: Workers, progress: Progress = lambda _, __: None
) -> Manifest:
    """Walk what the folder lacks, and write it there.

    Interrupted and called again, or called with more walks, it ends with the same files, to the byte, as when it is
    made at once by the same version on one kind of processor. Raises `InputError` where the folder holds another
    dataset, one made by another program, or more walks, and where another call writes to it.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{folder}: cannot be made ({error.strerror})") from None
    with in_use(folder):
        return _made(spec, folder, workers, progress)


def _made(spec: DatasetSpec, folder: Path, workers: Workers, progress: Progress) -> Manifest:
    manifest = _continued(spec, folder)
    wanted = shards_of(spec.walks, spec.shard)
    there = {(written.first, written.end) for written in manifest.shards if (folder / written.file).exists()}
    missing = [shard for shard in wanted if (shard.first, shard.end) not in there]
    manifest = _kept(manifest, spec, there, folder)
    numbers = [number for shard in missing for number in range(shard.first, shard.end)]
    found: dict[int, Row | str] = {}
    done = spec.walks - len(numbers)
    progress(done, spec.walks)
    for place, result in workers.run([WalkTask(spec, number) for number in numbers]):
        found[numbers[place]] = result
        done += 1
        shard = wanted[numbers[place] // spec.shard]
        if all(number in found for number in range(shard.first, shard.end)):
            written = _written(folder, shard, [found.pop(number) for number in range(shard.first, shard.end)])
            manifest = replace(manifest, shards=tuple(sorted([*manifest.shards, written], key=lambda one: one.first)))
            manifest.save(folder)
        progress(done, spec.walks)
    manifest.save(folder)
    write_card(folder, manifest)
    return manifest


def _continued(spec: DatasetSpec, folder: Path) -> Manifest:
    """The folder's manifest for this spec; only the number of walks may be another."""
    old, new = Manifest.load(folder), Manifest.new(spec)
    if old is None:
        return new
    before, now = asdict(old.spec), asdict(spec)
    other = [name for name in now if name != "walks" and before[name] != now[name]]
    if other:
        raise InputError(f"{folder}: holds a dataset with another {', '.join(other)}; choose another folder")
    if old.made_with != new.made_with:
        raise InputError(
            f"{folder}: was made by another version or on another kind of processor; choose another folder"
        )
    most = max((written.end for written in old.shards), default=0)
    if most > spec.walks:
        raise InputError(f"{folder}: holds {most} walks, not {spec.walks}; ask for more or choose another folder")
    return replace(old, spec=spec)


def _kept(manifest: Manifest, spec: DatasetSpec, there: set[tuple[int, int]], folder: Path) -> Manifest:
    """Without files that are gone, or that hold the end of fewer walks than are wanted now."""
    wanted = {(shard.first, shard.end) for shard in shards_of(spec.walks, spec.shard)}
    kept = [written for written in manifest.shards if (written.first, written.end) in there & wanted]
    for written in manifest.shards:
        if written not in kept:
            (folder / Path(written.file).name).unlink(missing_ok=True)
    return replace(manifest, shards=tuple(kept))


def _written(folder: Path, shard: Shard, results: list[Row | str]) -> Written:
    rows = [result for result in results if not isinstance(result, str)]
    rejected = {str(shard.first + k): why for k, why in enumerate(results) if isinstance(why, str)}
    digest = write_shard(folder, shard, rows)
    size = (folder / shard.name).stat().st_size
    seconds = round(sum(row["frames"] / row["fps"] for row in rows), 3)
    return Written(shard.name, shard.first, shard.end, digest, size, len(rows), seconds, rejected)
