"""Clearance of whole blocks of postures around the key times, and of single capsules along a motion."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.planning.exact.postures import BLOCK
from elbowroom.world.clearance import lower_to_box

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

COMFORT = 0.06  # metres: how much nearer something is than this, nobody asks


@exact_kernel
def boxes_around(boxes: Floats, place: Floats, reach: float, near: Floats) -> int:
    """Copy the boxes (B, 15) whose ball comes within `reach` of a place (3,) to `near`; their number."""
    count = 0
    for b in range(boxes.shape[0]):
        total, half = 0.0, 0.0
        for i in range(3):
            total += (boxes[b, i] - place[i]) ** 2
            half += boxes[b, 12 + i] ** 2
        if np.sqrt(total) - np.sqrt(half) < reach:
            for i in range(boxes.shape[1]):
                near[count, i] = boxes[b, i]
            count += 1
    return count


@exact_kernel
def relative_to(origin: Floats, boxes: Floats, count: int, places: Floats, out: Floats) -> None:
    """Move the first `count` boxes (B, 15) by minus a place (3,), and write `places` (N, 3) so moved to `out`."""
    for i in range(3):
        for b in range(count):
            boxes[b, i] -= origin[i]
        for n in range(places.shape[0]):
            out[n, i] = places[n, i] - origin[i]


@exact_kernel
def box_gap(box: Floats, x: float, y: float, z: float) -> float:
    """Distance of a point from a box (15,)."""
    total = 0.0
    dx, dy, dz = x - box[0], y - box[1], z - box[2]
    for i in range(3):
        place = box[3 + 3 * i] * dx + box[4 + 3 * i] * dy + box[5 + 3 * i] * dz
        beyond = max(abs(place) - box[12 + i], 0.0)
        total += beyond * beyond
    return float(np.sqrt(total))


@exact_kernel
def box_in_frame(box: Floats, place: Floats, turn: Floats, out: Floats) -> None:
    """The row (15,) of a box as seen from a frame at `place` (3,) with the unit quaternion `turn` (4,)."""
    x, y, z, w = turn[0], turn[1], turn[2], turn[3]
    xx, xy, xz = 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)
    yx, yy, yz = 2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)
    zx, zy, zz = 2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)
    dx, dy, dz = box[0] - place[0], box[1] - place[1], box[2] - place[2]
    out[0], out[1], out[2] = xx * dx + yx * dy + zx * dz, xy * dx + yy * dy + zy * dz, xz * dx + yz * dy + zz * dz
    for i in range(3):
        m = 3 + 3 * i
        p, q, r = box[m], box[m + 1], box[m + 2]
        out[m], out[m + 1], out[m + 2] = p * xx + q * yx + r * zx, p * xy + q * yy + r * zy, p * xz + q * yz + r * zz
        out[12 + i] = box[12 + i]


@exact_kernel
def lower_blocks(lanes: Floats32, balls: Floats, boxes: Floats, count: int, out: Floats32) -> int:
    """Lower `out` (B, 16) to the clearance of blocks of postures from `count` boxes, all in one frame.

    What is farther away than `COMFORT` may be left out. Returns the capsules that were checked.
    """
    checks = 0
    row = np.empty(15, np.float32)
    for i in range(count):
        box = boxes[i]
        for k in range(15):
            row[k] = box[k]
        for b in range(lanes.shape[0]):
            for c in range(lanes.shape[1]):
                if box_gap(box, balls[b, c, 0], balls[b, c, 1], balls[b, c, 2]) < balls[b, c, 3] + COMFORT:
                    lower_to_box(lanes[b, c], row, out[b])
                    checks += BLOCK
    return checks


@exact_kernel
def place_capsules(segments: Floats32, radii: Floats32, places: Floats, turns: Floats, lanes: Floats32) -> None:
    """Capsules (C, 6, N) in frames at `places` (N, 3), `turns` (N, 4), as lanes (C, 7, W) outside of them, W >= N.

    The lanes beyond N repeat the last.
    """
    count = segments.shape[2]
    for n in range(lanes.shape[2]):
        m = min(n, count - 1)
        x, y, z, w = turns[m, 0], turns[m, 1], turns[m, 2], turns[m, 3]
        xx, xy, xz = 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)
        yx, yy, yz = 2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)
        zx, zy, zz = 2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)
        for c in range(segments.shape[0]):
            for e in range(0, 6, 3):
                a, b, d = segments[c, e, m], segments[c, e + 1, m], segments[c, e + 2, m]
                lanes[c, e, n] = places[m, 0] + xx * a + xy * b + xz * d
                lanes[c, e + 1, n] = places[m, 1] + yx * a + yy * b + yz * d
                lanes[c, e + 2, n] = places[m, 2] + zx * a + zy * b + zz * d
            lanes[c, 6, n] = radii[c]


@exact_kernel
def capsule_clearances(lanes: Floats32, boxes: Floats, count: int, out: Floats32) -> int:
    """Lower `out` (C, W) to the clearance of each capsule in each lane; boxes far from all of a capsule's are left out.

    Returns the capsules that were checked.
    """
    row = np.empty(15, np.float32)
    checks = 0
    for c in range(lanes.shape[0]):
        low, high, total = np.empty(3), np.empty(3), 0.0
        for k in range(3):
            low[k], high[k] = np.inf, -np.inf
            for e in range(0, 6, 3):
                for n in range(lanes.shape[2]):
                    low[k], high[k] = min(low[k], lanes[c, e + k, n]), max(high[k], lanes[c, e + k, n])
            total += (high[k] - low[k]) * (high[k] - low[k])
        ball = lanes[c, 6, 0] + 0.5 * np.sqrt(total)
        x, y, z = 0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), 0.5 * (low[2] + high[2])
        for b in range(count):
            if box_gap(boxes[b], x, y, z) < ball + COMFORT:
                for k in range(15):
                    row[k] = boxes[b, k]
                lower_to_box(lanes[c], row, out[c])
                checks += lanes.shape[2]
    return checks
