"""Arrays by name as a NumPy archive or a table of comma-separated values."""

import io
import zipfile
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray


def write_npz(arrays: Mapping[str, NDArray[np.generic]]) -> bytes:
    """A compressed archive that `numpy.load` reads without pickle; the same arrays give the same bytes."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, array in arrays.items():
            member = io.BytesIO()
            np.lib.format.write_array(member, np.asarray(array), allow_pickle=False)
            archive.writestr(zipfile.ZipInfo(f"{name}.npy"), member.getvalue(), zipfile.ZIP_DEFLATED)
    return out.getvalue()


def write_csv(columns: Mapping[str, NDArray[np.float64]]) -> bytes:
    """A header and a row for each frame; columns (F,) in the order given, numbers with nine digits."""
    rows = np.column_stack(list(columns.values()))
    lines = [",".join(columns), *(",".join(f"{value:.9g}" for value in row) for row in rows.tolist())]
    return "\n".join([*lines, ""]).encode()
