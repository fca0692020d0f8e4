"""The filters that meshoptimizer puts before its vertex codec, undone.

Source: EXT_meshopt_compression, appendix "Filters", and KHR_meshopt_compression for COLOR (Khronos glTF extensions).
"""

import numpy as np
from numpy.typing import NDArray

Bytes = NDArray[np.uint8]
Floats = NDArray[np.float32]


def octahedral(elements: Bytes) -> Bytes:
    """Unit vectors (count, 4 or 8 bytes) from two octahedral coordinates and the value of 1; the fourth stays."""
    kind = np.dtype(np.int8 if elements.shape[1] == 4 else "<i2")
    values = elements.view(kind).reshape(-1, 4).copy()
    most = np.float32(np.iinfo(kind).max)
    x, y = values[:, 0].astype(np.float32), values[:, 1].astype(np.float32)
    z = values[:, 2].astype(np.float32) - np.abs(x) - np.abs(y)
    fold = np.minimum(z, 0.0)
    x += np.where(x >= 0.0, fold, -fold)
    y += np.where(y >= 0.0, fold, -fold)
    with np.errstate(all="ignore"):
        scale = most / np.sqrt(x * x + y * y + z * z)
        for column, value in enumerate((x, y, z)):
            values[:, column] = _rounded(value * scale, kind)
    return values.view(np.uint8).reshape(elements.shape)


def quaternions(elements: Bytes) -> Bytes:
    """Unit quaternions (count, 8 bytes) from their three smaller components and the place of the largest."""
    values = elements.view("<i2").reshape(-1, 4).astype(np.int32)
    scale = np.float32(1.0 / np.sqrt(2.0)) / (values[:, 3] | 3).astype(np.float32)
    small = values[:, :3].astype(np.float32) * scale[:, None]
    largest = np.sqrt(np.maximum(1.0 - np.sum(small * small, axis=1, dtype=np.float32), 0.0))
    out = np.empty((len(values), 4), "<i2")
    rows, place = np.arange(len(values)), values[:, 3] & 3
    for column in range(3):
        out[rows, (place + column + 1) & 3] = _rounded(small[:, column] * np.float32(32767.0), out.dtype)
    out[rows, place] = _rounded(largest.astype(np.float32) * np.float32(32767.0), out.dtype)
    return out.view(np.uint8).reshape(elements.shape)


def exponential(elements: Bytes) -> Bytes:
    """Floats (count, 4 n bytes) from an exponent of 8 and a mantissa of 24 bits."""
    values = elements.view("<i4")
    mantissa = (values << 8) >> 8
    with np.errstate(all="ignore"):
        decoded = np.ldexp(mantissa.astype(np.float64), values >> 24).astype("<f4")
    plain: Bytes = decoded.view(np.uint8).reshape(elements.shape)
    return plain


def color(elements: Bytes) -> Bytes:
    """RGBA (count, 4 or 8 bytes) from YCoCg with the number of bits in alpha's highest bit."""
    kind = np.dtype(np.uint8 if elements.shape[1] == 4 else "<u2")
    values = elements.view(kind).reshape(-1, 4).astype(np.int32)
    signed = elements.view(np.dtype(kind.str.replace("u", "i"))).reshape(-1, 4).astype(np.int32)
    y, co, cg, alpha = values[:, 0], signed[:, 1], signed[:, 2], values[:, 3]
    span = alpha.copy()
    for shift in (1, 2, 4, 8):
        span |= span >> shift
    parts = (y + co - cg, y + cg, y - co - cg, ((alpha << 1) & span) | (alpha & 1))
    scale = np.float32(np.iinfo(kind).max) / np.maximum(span, 1).astype(np.float32)
    out = np.stack([(part.astype(np.float32) * scale + np.float32(0.5)).astype(np.int32) for part in parts], axis=1)
    return out.astype(kind).view(np.uint8).reshape(elements.shape)


def _rounded(values: Floats, kind: np.dtype[np.generic]) -> NDArray[np.generic]:
    """Rounded half away from zero."""
    return np.nan_to_num(np.trunc(values + np.copysign(np.float32(0.5), values))).astype(np.int32).astype(kind)
