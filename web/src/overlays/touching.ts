/** Which capsules of the body are inside an obstacle: exact distances between segments and convex bodies. */

import { distanceToBounds, distanceToBox, type PreparedBox } from "../camera/spring_arm";

const GOLDEN = (Math.sqrt(5) - 1) / 2;
const ROUNDS = 18;

/** Distance in metres from the segment at `at` (ax, ay, az, bx, by, bz) to a box; 0 where they meet. */
export function segmentBoxDistance(box: PreparedBox, segments: ArrayLike<number>, at: number): number {
  return nearestOnSegment(box, segments, at).distance;
}

/** The place on the segment that is nearest to the box: its share of the way from a to b, and the distance there. */
export function nearestOnSegment(
  box: PreparedBox, segments: ArrayLike<number>, at: number,
): { readonly share: number; readonly distance: number } {
  const ax = segments[at] ?? 0, ay = segments[at + 1] ?? 0, az = segments[at + 2] ?? 0;
  const dx = (segments[at + 3] ?? 0) - ax, dy = (segments[at + 4] ?? 0) - ay, dz = (segments[at + 5] ?? 0) - az;
  const distance = (t: number) => distanceToBox(box, ax + dx * t, ay + dy * t, az + dz * t);
  // The distance to a convex body is convex along a line, so golden sections close in on its minimum.
  let low = 0;
  let high = 1;
  let left = high - GOLDEN;
  let right = GOLDEN;
  let atLeft = distance(left);
  let atRight = distance(right);
  for (let round = 0; round < ROUNDS; round++) {
    if (atLeft <= atRight) {
      high = right;
      right = left;
      atRight = atLeft;
      left = high - GOLDEN * (high - low);
      atLeft = distance(left);
    } else {
      low = left;
      left = right;
      atLeft = atRight;
      right = low + GOLDEN * (high - low);
      atRight = distance(right);
    }
  }
  const candidates = [left, right, 0, 1].map((share) => ({ share, distance: distance(share) }));
  return candidates.reduce((best, next) => (next.distance < best.distance ? next : best));
}

/** Whether capsule `i` touches anything. */
export function capsuleTouches(
  boxes: readonly PreparedBox[], segments: ArrayLike<number>, i: number, radius: number,
): boolean {
  const at = 6 * i;
  const mx = ((segments[at] ?? 0) + (segments[at + 3] ?? 0)) / 2;
  const my = ((segments[at + 1] ?? 0) + (segments[at + 4] ?? 0)) / 2;
  const mz = ((segments[at + 2] ?? 0) + (segments[at + 5] ?? 0)) / 2;
  const half = Math.hypot((segments[at + 3] ?? 0) - mx, (segments[at + 4] ?? 0) - my, (segments[at + 5] ?? 0) - mz);
  return boxes.some(
    (box) => distanceToBounds(box, mx, my, mz) < radius + half && segmentBoxDistance(box, segments, at) < radius,
  );
}
