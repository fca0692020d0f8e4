"""How a prim places what is in it: its xformOps at any time (openusd.org, "UsdGeomXformable")."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.animations import KeyedTrack, sample
from elbowroom.formats.usd.prims import Attribute, Prim
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

_PREFIX, _INVERSE = "xformOp:", "!invert!"
_MAX_OPS = 32
_SHEAR = 1e-3


def sampled_times(prim: Prim) -> Floats:
    """The time codes (T,) at which its place is told, sorted; empty where it stays."""
    names = [name.removeprefix(_INVERSE) for name in prim.texts("xformOpOrder")]
    return np.array(sorted({time for name in names for time in _attribute(prim, name).samples}))


def places(prim: Prim, times: Floats | None) -> tuple[Floats, Floats, Floats]:
    """Translations (F, 3), rotations (F, 4) and scale (3,) at time codes (F,); None: outside of time, one row.

    Raises `InputError` for an unknown operation, wrong numbers, and transforms with shear or a mirror.
    """
    names = prim.texts("xformOpOrder")
    if len(names) > _MAX_OPS:
        raise InputError(f"{prim.file}: {prim.path} has more than {_MAX_OPS} xformOps")
    matrices = np.tile(np.eye(4), (1 if times is None else len(times), 1, 1))
    for name in names:
        plain = name.removeprefix(_INVERSE)
        operation = _matrices(plain, prim, times)
        if name != plain:
            operation = _inverse(operation, prim)
        matrices = matrices @ operation
    scales = np.linalg.norm(matrices[:, :3, :3], axis=1)
    if not scales.min() > 1e-9:
        raise InputError(f"{prim.file}: {prim.path}: its transform cannot be inverted")
    axes = matrices[:, :3, :3] / scales[:, None, :]
    straight = np.abs(np.swapaxes(axes, 1, 2) @ axes - np.eye(3)).max() < _SHEAR
    if not straight or np.linalg.det(axes).min() < 0.0:
        raise InputError(f"{prim.file}: {prim.path}: its transform shears or mirrors")
    turns = np.stack([quaternion.from_matrix(each) for each in axes])
    return matrices[:, :3, 3], turns, scales[0]


def _attribute(prim: Prim, name: str) -> Attribute:
    return prim.attributes.get(name, Attribute())


def values_at(prim: Prim, name: str, width: int, times: Floats | None) -> Floats:
    """An attribute's rows (F, width) at time codes (F,), between samples in straight lines; None: outside of time."""
    known = _attribute(prim, name)
    if times is None or not known.samples:
        first = known.value if known.value is not None else next(iter(known.samples.values()), None)
        return np.tile(_row(prim, name, width, first), (1 if times is None else len(times), 1))
    keys = sorted(known.samples)
    rows = np.stack([_row(prim, name, width, known.samples[key]) for key in keys])
    return sample(KeyedTrack(0, "", "LINEAR", np.array(keys), rows), times)


def _row(prim: Prim, name: str, width: int, value: object) -> Floats:
    if not isinstance(value, np.ndarray) or value.shape != (width,):
        raise InputError(f"{prim.file}: {prim.path}.{name} must have {width} numbers")
    return value


def _matrices(name: str, prim: Prim, times: Floats | None) -> Floats:
    """An operation's matrices (F, 4, 4), for columns."""
    kind = name.removeprefix(_PREFIX).split(":")[0]
    if kind == "transform":
        return np.swapaxes(values_at(prim, name, 16, times).reshape(-1, 4, 4), 1, 2)
    if kind == "orient":
        return _turned(quaternion.normalize(values_at(prim, name, 4, times)[:, [1, 2, 3, 0]]))
    if kind in ("translate", "scale"):
        values = values_at(prim, name, 3, times)
        matrices = np.tile(np.eye(4), (len(values), 1, 1))
        if kind == "translate":
            matrices[:, :3, 3] = values
        else:
            matrices[:, [0, 1, 2], [0, 1, 2]] = values
        return matrices
    axes = kind.removeprefix("rotate")
    if not kind.startswith("rotate") or not axes or len(axes) > 3 or set(axes) - set("XYZ"):
        raise InputError(f"{prim.file}: {prim.path}: {name[:40]!r} is no operation that is known")
    angles = np.deg2rad(values_at(prim, name, len(axes), times))
    if len(axes) == 3:
        angles = angles[:, ["XYZ".index(axis) for axis in axes]]
    turns = np.tile(quaternion.IDENTITY, (len(angles), 1))
    for i, axis in enumerate(axes):  # the first one turns first
        turns = quaternion.multiply(quaternion.about_axis("XYZ".index(axis), angles[:, i]), turns)
    return _turned(turns)


def _turned(turns: Floats) -> Floats:
    matrices = np.tile(np.eye(4), (len(turns), 1, 1))
    matrices[:, :3, :3] = np.stack([quaternion.to_matrix(turn) for turn in turns])
    return matrices


def _inverse(matrices: Floats, prim: Prim) -> Floats:
    try:
        inverse: Floats = np.asarray(np.linalg.inv(matrices), np.float64)
    except np.linalg.LinAlgError:
        raise InputError(f"{prim.file}: {prim.path}: its transform cannot be inverted") from None
    return inverse
