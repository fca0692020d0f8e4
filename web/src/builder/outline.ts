/** What a board shows of things: their outlines, as seen from above or from the side. */

import type { Shape, Thing, Turn, Vec2, Vec3 } from "./plan";
import { halfSize } from "./shapes";
import { turned } from "./turns";

/** From above +Z is up and +X left, as who walks along +Z has its left; from the side +Z is to the right and Y up. */
export type Side = "top" | "side";

const ROUND = 24;

/** Where a point of the world is on the board, metres to the right and down. */
export function onBoard(side: Side, [x, y, z]: Vec3): Vec2 {
  return side === "top" ? [-x, -z] : [z, -y];
}

/** How far something moves in the world that moves so far on the board. */
export function inWorld(side: Side, [right, down]: Vec2): Vec3 {
  return side === "top" ? [-right, 0, -down] : [0, -down, right];
}

/** The outline of a thing at a place: the corners of a polygon on the board. */
export function outline(side: Side, { shape }: Thing, center: Vec3, rotation: Turn): readonly Vec2[] {
  const points = cornersOf(shape).map((corner) => {
    const [x, y, z] = turned(corner, rotation);
    return onBoard(side, [x + center[0], y + center[1], z + center[2]]);
  });
  return convexHull(points);
}

/** Points whose convex hull is the shape, or nearly. */
function cornersOf(shape: Shape): readonly Vec3[] {
  if (shape.type === "hull") return shape.points;
  if (shape.type === "mesh") return shape.vertices;
  const [x, y, z] = halfSize(shape);
  if (shape.type === "box") return [-1, 1].flatMap((a) => [-1, 1].flatMap((b) => [-1, 1].map((c): Vec3 => [a * x, b * y, c * z])));
  if (shape.type === "cylinder") return [-y, y].flatMap((height) => ring(x, height));
  const rises = [-1, -0.92, -0.71, -0.38, 0, 0.38, 0.71, 0.92, 1];
  const straight = y - x;
  return rises.flatMap((rise) => ring(x * Math.sqrt(1 - rise * rise), x * rise + Math.sign(rise) * straight));
}

function ring(radius: number, height: number): Vec3[] {
  return Array.from({ length: ROUND }, (_, i): Vec3 => {
    const angle = (2 * Math.PI * i) / ROUND;
    return [radius * Math.cos(angle), height, radius * Math.sin(angle)];
  });
}

/** Andrew's monotone chain. */
export function convexHull(points: readonly Vec2[]): readonly Vec2[] {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const chain = (ordered: readonly Vec2[]): Vec2[] => {
    const kept: Vec2[] = [];
    for (const point of ordered) {
      while (kept.length > 1 && !turnsLeft(kept[kept.length - 2] as Vec2, kept[kept.length - 1] as Vec2, point)) kept.pop();
      kept.push(point);
    }
    return kept.slice(0, -1);
  };
  return [...chain(sorted), ...chain(sorted.reverse())];
}

function turnsLeft(a: Vec2, b: Vec2, c: Vec2): boolean {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0;
}
