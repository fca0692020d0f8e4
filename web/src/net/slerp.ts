/** Spherical interpolation of quaternions that lie one after another in flat arrays. */

/** Writes the quaternion at `at` between `a` and `b` into `out`, the short way round; unit length is kept. */
export function slerpInto(
  out: Float32Array, at: number, a: ArrayLike<number>, b: ArrayLike<number>, share: number,
): void {
  const ax = a[at] ?? 0, ay = a[at + 1] ?? 0, az = a[at + 2] ?? 0, aw = a[at + 3] ?? 1;
  let bx = b[at] ?? 0, by = b[at + 1] ?? 0, bz = b[at + 2] ?? 0, bw = b[at + 3] ?? 1;
  let cosine = ax * bx + ay * by + az * bz + aw * bw;
  if (cosine < 0) {
    cosine = -cosine;
    bx = -bx;
    by = -by;
    bz = -bz;
    bw = -bw;
  }
  let wa = 1 - share;
  let wb = share;
  if (cosine < 0.9995) {
    const angle = Math.acos(cosine);
    const sine = Math.sin(angle);
    wa = Math.sin(wa * angle) / sine;
    wb = Math.sin(wb * angle) / sine;
  }
  const x = wa * ax + wb * bx;
  const y = wa * ay + wb * by;
  const z = wa * az + wb * bz;
  const w = wa * aw + wb * bw;
  const size = Math.hypot(x, y, z, w) || 1;
  out[at] = x / size;
  out[at + 1] = y / size;
  out[at + 2] = z / size;
  out[at + 3] = w / size;
}
