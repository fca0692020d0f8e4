/**
 * The geometry of the camera's spring arm: how far a sphere may travel from the pivot before it touches a box.
 *
 * The distance from a point to a convex body is 1-Lipschitz along a line, so stepping by "distance minus radius" never
 * passes the first contact (conservative advancement). No engine, no approximation of the obstacles.
 */

import type { ConvexBody } from "./convex_body";
import type { Quat, Vec3 } from "./vectors";

/** A convex body in an oriented box: centre and half sizes in metres, box-to-world rotation as a quaternion xyzw. */
export interface OrientedBox {
  readonly center: Vec3;
  readonly rotation: Quat;
  readonly halfSize: Vec3;
  /** What is in the box; it is full where this is absent. */
  readonly body?: ConvexBody;
  /** What is in it is told by its triangles, all round which there is room: it is no body, and far from everything. */
  readonly hollow?: boolean;
}

/** The same with its world-to-box rotation as a row-major matrix, ready for many distance queries. */
export interface PreparedBox {
  readonly center: Vec3;
  readonly toBox: readonly [number, number, number, number, number, number, number, number, number];
  readonly halfSize: Vec3;
  readonly body?: ConvexBody;
  readonly hollow?: boolean;
}

const CONTACT_TOLERANCE = 1e-4;
const RETREAT_STEP = 0.02;
const MAX_STEPS = 128;
/** Metres round the line of sight that walls must leave free: one sees through a door that is narrower than the camera's own room. */
const SIGHT = 0.12;
/** How fast a sphere that begins squeezed grows to its full radius, metres per metre. */
const PROBE_GROWTH = 0.5;

/** Precomputes the world-to-box rotation. */
export function prepareBox(box: OrientedBox): PreparedBox {
  const [x, y, z, w] = box.rotation;
  return {
    center: box.center,
    halfSize: box.halfSize,
    ...(box.body && { body: box.body }),
    ...(box.hollow && { hollow: true }),
    toBox: [
      1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w),
      2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w),
      2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y),
    ],
  };
}

/** Distance in metres from a point to what is in a box; 0 inside, +Infinity where it is hollow. */
export function distanceToBox(box: PreparedBox, px: number, py: number, pz: number): number {
  if (box.hollow) return Infinity;
  if (!box.body) return distanceToBounds(box, px, py, pz);
  const [x, y, z] = nearestOnBox(box, px, py, pz);
  return Math.hypot(px - x, py - y, pz - z);
}

/** Distance in metres from a point to the box itself: no more than that to what is in it; +Infinity where it is hollow. */
export function distanceToBounds(box: PreparedBox, px: number, py: number, pz: number): number {
  if (box.hollow) return Infinity;
  const m = box.toBox;
  const dx = px - box.center[0];
  const dy = py - box.center[1];
  const dz = pz - box.center[2];
  const ex = Math.max(Math.abs(m[0] * dx + m[1] * dy + m[2] * dz) - box.halfSize[0], 0);
  const ey = Math.max(Math.abs(m[3] * dx + m[4] * dy + m[5] * dz) - box.halfSize[1], 0);
  const ez = Math.max(Math.abs(m[6] * dx + m[7] * dy + m[8] * dz) - box.halfSize[2], 0);
  return Math.sqrt(ex * ex + ey * ey + ez * ez);
}

/** The point of what is in the box (surface or inside) that is nearest to a point. */
export function nearestOnBox(box: PreparedBox, px: number, py: number, pz: number): Vec3 {
  const m = box.toBox;
  const dx = px - box.center[0];
  const dy = py - box.center[1];
  const dz = pz - box.center[2];
  const clamp = (value: number, half: number) => Math.min(half, Math.max(-half, value));
  const inside: Vec3 = [
    m[0] * dx + m[1] * dy + m[2] * dz, m[3] * dx + m[4] * dy + m[5] * dz, m[6] * dx + m[7] * dy + m[8] * dz,
  ];
  const [x, y, z] = box.body
    ? box.body.nearest(inside)
    : [clamp(inside[0], box.halfSize[0]), clamp(inside[1], box.halfSize[1]), clamp(inside[2], box.halfSize[2])];
  return [
    box.center[0] + m[0] * x + m[3] * y + m[6] * z,
    box.center[1] + m[1] * x + m[4] * y + m[7] * z,
    box.center[2] + m[2] * x + m[5] * y + m[8] * z,
  ];
}

/** Distance in metres from a point to the nearest box; +Infinity with no boxes. */
export function distanceToBoxes(boxes: readonly PreparedBox[], px: number, py: number, pz: number): number {
  let nearest = Infinity;
  for (const box of boxes) nearest = Math.min(nearest, distanceToBox(box, px, py, pz));
  return nearest;
}

/**
 * How far a sphere may move from `origin` along the unit vector `direction` before it touches a box or the ground.
 *
 * Where the sphere already touches at the origin, it begins with what fits there and grows on the way, so that the
 * arm can still leave a tight spot.
 *
 * @param reach the wanted distance, metres
 * @param radius the sphere's, metres
 * @returns a distance in [0, reach]
 */
export function freeReach(
  boxes: readonly PreparedBox[], origin: Vec3, direction: Vec3, reach: number, radius: number,
): number {
  const [ox, oy, oz] = origin;
  const [dx, dy, dz] = direction;
  let limit = reach;
  if (dy < 0 && oy > 0) limit = Math.min(limit, Math.max(0, (oy - radius) / -dy));
  const room = distanceToBoxes(boxes, ox, oy, oz);
  let travelled = 0;
  for (let step = 0; step < MAX_STEPS; step++) {
    const probe = Math.min(radius, room * 0.9 + PROBE_GROWTH * travelled);
    const gap = distanceToBoxes(boxes, ox + dx * travelled, oy + dy * travelled, oz + dz * travelled) - probe;
    if (gap < CONTACT_TOLERANCE) break;
    travelled += gap / (1 + PROBE_GROWTH);
    if (travelled >= limit) return limit;
  }
  return Math.min(travelled, limit);
}

/** Whether the box is a wall or a floor: at least this large in two directions. What is smaller is furniture. */
export function isWall(box: PreparedBox, size = 1.8): boolean {
  if (box.hollow) return false;
  const sizes = box.halfSize.map((half) => 2 * half).sort((a, b) => b - a);
  return (sizes[1] ?? 0) >= size;
}

/** Obstacles as the camera sees them. */
export interface CameraObstacles {
  readonly all: readonly PreparedBox[];
  /** Those that hold the arm back; past the others the camera looks through, they fade. */
  readonly walls: readonly PreparedBox[];
  /** How far one sees from a point along a unit vector, at most so many metres: for what is no box. */
  readonly sight?: (from: Vec3, direction: Vec3, reach: number) => number;
}

/**
 * How far from the pivot the camera may be: no wall lies between, and no box of any kind within `radius` of the camera itself.
 *
 * Without assist the avatar walks through walls too; one that the pivot is inside cannot hold the arm back.
 */
export function cameraReach(
  obstacles: CameraObstacles, pivot: Vec3, direction: Vec3, wanted: number, radius: number,
): number {
  const walls = obstacles.walls.filter((wall) => distanceToBox(wall, ...pivot) > CONTACT_TOLERANCE);
  let reach = freeReach(walls, pivot, direction, wanted, Math.min(radius, SIGHT));
  while (reach > 0) {
    const room = distanceToBoxes(obstacles.all, ...pointAlong(pivot, direction, reach));
    if (room >= radius - 2 * CONTACT_TOLERANCE) return reach;
    reach -= Math.max(radius - room, RETREAT_STEP);
  }
  return 0;
}

/** The point at a distance from `from` along a unit vector. */
export function pointAlong(from: Vec3, direction: Vec3, distance: number): [number, number, number] {
  return [from[0] + direction[0] * distance, from[1] + direction[1] * distance, from[2] + direction[2] * distance];
}
