"""Triangles into pixels: a depth buffer, flat shading, and nothing else."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel

Floats = NDArray[np.float64]


@exact_kernel
def draw(
    points: Floats,
    triangles: NDArray[np.int64],
    colors: Floats,
    light: Floats,
    image: Floats,
    depth: Floats,
) -> None:
    """Draw triangles (T, 3) over points (V, 3), pixel columns, rows, nearness, into image (H, W, 3), depth (H, W).

    `colors` (T, 3) are shaded by how far each face turns to the direction `light` (3,); both sides are seen.
    """
    height, width = depth.shape
    for t in range(len(triangles)):
        a, b, c = points[triangles[t, 0]], points[triangles[t, 1]], points[triangles[t, 2]]
        ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
        vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        length = np.sqrt(nx * nx + ny * ny + nz * nz)
        if length < 1e-12 or abs(nz) < 1e-9:
            continue
        turn = 1.0 if nz > 0.0 else -1.0
        shade = 0.45 + 0.55 * max(turn * (nx * light[0] + ny * light[1] + nz * light[2]) / length, 0.0)
        left = max(int(np.floor(min(a[0], b[0], c[0]))), 0)
        right = min(int(np.ceil(max(a[0], b[0], c[0]))), width - 1)
        top = max(int(np.floor(min(a[1], b[1], c[1]))), 0)
        bottom = min(int(np.ceil(max(a[1], b[1], c[1]))), height - 1)
        for row in range(top, bottom + 1):
            for column in range(left, right + 1):
                x, y = column + 0.5 - a[0], row + 0.5 - a[1]
                s, r = (x * vy - y * vx) / nz, (y * ux - x * uy) / nz
                if s < 0.0 or r < 0.0 or s + r > 1.0:
                    continue
                near = a[2] + s * uz + r * vz
                if near > depth[row, column]:
                    depth[row, column] = near
                    for i in range(3):
                        image[row, column, i] = shade * colors[t, i]
