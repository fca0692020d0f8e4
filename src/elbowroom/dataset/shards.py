"""The files of a dataset: each holds the walks of a range of numbers, written whole or not at all."""

import hashlib
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from elbowroom.dataset.columns import COLUMNS, F32, SCHEMA, leaves
from elbowroom.dataset.row import Row
from elbowroom.errors import InputError

# The bytes of floats that change little from frame to frame lie apart, the first of all, the second of all: two thirds
# of the size. What is no float is told by the numbers of what there is.
_FLOATS, _OTHERS = ([path for path, kind in leaves(SCHEMA) if (kind == F32) is floats] for floats in (True, False))
_ENCODING = {"use_byte_stream_split": _FLOATS, "use_dictionary": _OTHERS}


class Shard(NamedTuple):
    """Which walks a file is for."""

    first: int
    end: int  # one past the last

    @property
    def name(self) -> str:
        """Of its file."""
        return f"walks-{self.first:08d}-{self.end - 1:08d}.parquet"


def shards_of(walks: int, size: int) -> list[Shard]:
    """The files for so many walks."""
    return [Shard(first, min(first + size, walks)) for first in range(0, walks, size)]


def write_shard(folder: Path, shard: Shard, rows: Sequence[Row]) -> str:
    """Write a file, rows in the order of their numbers; gives its SHA-256. The same rows give the same bytes."""
    ordered = sorted(rows, key=lambda row: int(row["walk"]))
    columns = [_column(column.kind, [row[column.name] for row in ordered]) for column in COLUMNS]
    path, part = folder / shard.name, folder / f".{shard.name}.part"
    try:
        table = pa.Table.from_arrays(columns, schema=SCHEMA)
        pq.write_table(table, part, compression="zstd", compression_level=9, **_ENCODING)
        with part.open("rb") as file:
            os.fsync(file.fileno())
        part.replace(path)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise InputError(f"{path}: cannot be written ({error.strerror})") from None
    return sha256(path)


def read_shard(path: Path) -> pa.Table:
    """The rows of a file; raises `InputError` where it is damaged or of another kind."""
    try:
        table = pq.read_table(path)
    except (OSError, pa.ArrowException) as error:
        raise InputError(f"{path}: cannot be read as Parquet ({str(error).splitlines()[0][:120]})") from None
    if not table.schema.equals(SCHEMA):
        raise InputError(f"{path}: its columns are not those of a dataset of walks of this version")
    return table


def sha256(path: Path) -> str:
    """Of a file's content; raises `InputError` where it cannot be read."""
    total = hashlib.sha256()
    try:
        with path.open("rb") as file:
            while block := file.read(1 << 20):
                total.update(block)
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from None
    return total.hexdigest()


def _column(kind: pa.DataType, values: list[Any]) -> pa.Array:
    """The values of all rows; arrays (F,) and (F, W) become lists without a Python object for each number."""
    if not values or not isinstance(values[0], np.ndarray):
        return pa.array(values, kind)
    inner = kind.value_type
    flat = np.concatenate([value.reshape(-1) for value in values])
    offsets = np.concatenate([[0], np.cumsum([len(value) for value in values])]).astype(np.int32)
    if pa.types.is_fixed_size_list(inner):
        numbers = pa.array(flat.astype(inner.value_type.to_pandas_dtype()), inner.value_type)
        return pa.ListArray.from_arrays(offsets, pa.FixedSizeListArray.from_arrays(numbers, inner.list_size), type=kind)
    return pa.ListArray.from_arrays(offsets, pa.array(flat.astype(inner.to_pandas_dtype()), inner), type=kind)
