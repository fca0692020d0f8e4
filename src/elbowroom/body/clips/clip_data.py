"""Clips as JSON: how they are written and how they are checked.

A file holds `{"part": "waist" | "arm", "clips": [clip, ...]}`. A clip is
`{"name": str, "source": str, "loop": bool, "keys": [[time, value, ...], ...]}`: times increase from 0, values stand in
the order of the group's degrees of freedom (`body/dof.py`), angles in degrees, the lowering in half leg lengths. Arm
clips are written once, for both sides: equal values make mirrored gestures. A loop's last key repeats its first values.
"""

import json
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL_GROUPS, LOWERING, DofGroup, clamp
from elbowroom.errors import InputError

_PARTS = {
    part: tuple(group for group in LOCAL_GROUPS if group.value.clips == part)
    for part in dict.fromkeys(group.value.clips for group in LOCAL_GROUPS)
}
_MAX_CLIPS, _MAX_KEYS = 200, 2000


@dataclass(frozen=True, eq=False)
class ClipData:
    """One clip as it stands in a file, already in radians."""

    name: str
    source: str  # publication that the angles come from, or "authored"
    loop: bool
    groups: tuple[DofGroup, ...]  # the groups that can play it
    times: NDArray[np.float64]  # (K,) seconds
    configurations: NDArray[np.float64]  # (K, d) radians


def parse_clips(text: str, file: str) -> tuple[ClipData, ...]:
    """Read a clip file's text; `file` is its name for error messages. Raises `InputError`."""
    try:
        data = json.loads(text)
    except (json.JSONDecodeError, RecursionError) as error:
        raise InputError(f"{file}: not JSON ({error})") from None
    if not isinstance(data, dict) or data.get("part") not in _PARTS:
        raise InputError(f'{file}: field "part" must be one of {", ".join(_PARTS)}')
    clips = data.get("clips")
    if not isinstance(clips, list) or not 0 < len(clips) <= _MAX_CLIPS:
        raise InputError(f'{file}: field "clips" must be a list of 1 to {_MAX_CLIPS} clips')
    groups = _PARTS[str(data["part"])]
    return tuple(_clip(clip, groups, f"{file}: clips[{i}]") for i, clip in enumerate(clips))


def _clip(data: object, groups: tuple[DofGroup, ...], place: str) -> ClipData:
    if not isinstance(data, dict):
        raise InputError(f"{place} must be an object, found {type(data).__name__}")
    for field, kind in (("name", str), ("source", str), ("loop", bool), ("keys", list)):
        if not isinstance(data.get(field), kind):
            raise InputError(f"{place}.{field} must be a {kind.__name__}, found {data.get(field)!r:.60}")
    keys = _keys(data["keys"], groups[0], f"{place}.keys")
    if data["loop"] and not np.array_equal(keys[0, 1:], keys[-1, 1:]):
        raise InputError(f"{place}.keys: the last key of a loop must repeat the first one's values")
    return ClipData(data["name"], data["source"], data["loop"], groups, keys[:, 0], keys[:, 1:] * _units(groups[0]))


def _keys(rows: list[object], group: DofGroup, place: str) -> NDArray[np.float64]:
    width = 1 + group.size
    if not 2 <= len(rows) <= _MAX_KEYS:
        raise InputError(f"{place} must hold 2 to {_MAX_KEYS} keys, found {len(rows)}")
    for i, row in enumerate(rows):
        numbers = isinstance(row, list) and len(row) == width
        if not numbers or not all(type(v) in (int, float) and np.isfinite(v) for v in row):  # type: ignore[attr-defined]
            raise InputError(f"{place}[{i}] must be {width} numbers: a time and {group.size} values, found {row!r:.60}")
    keys = np.array(rows, np.float64)
    if keys[0, 0] != 0.0 or not np.all(np.diff(keys[:, 0]) > 0.0):
        raise InputError(f"{place}: times must start at 0 and increase")
    values = keys[:, 1:] * _units(group)
    outside = np.flatnonzero(np.any(np.abs(clamp(group, values) - values) > 1e-9, axis=1))
    if len(outside):
        raise InputError(f"{place}[{outside[0]}]: {keys[outside[0], 1:].tolist()} is beyond the limits of the joint")
    return keys


def _units(group: DofGroup) -> NDArray[np.float64]:
    """What a file's values (d,) are multiplied by: degrees become radians, the lowering stays."""
    columns = np.arange(group.at.start, group.at.stop)
    return np.where(columns == LOWERING, 1.0, np.deg2rad(1.0))
