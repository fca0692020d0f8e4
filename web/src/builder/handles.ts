/** What pulling at a corner does to a shape. */

import { yawOf } from "./edits";
import type { Shape, Thing, Vec2 } from "./plan";
import { halfSize, length, scaled } from "./shapes";

/** The shape after its corner was pulled to a point: metres from its middle along X and Z of the world. */
export function resized(thing: Thing, [x, z]: Vec2, snapped: (metres: number) => number): Shape {
  const { shape } = thing, yaw = yawOf(thing);
  const along: Vec2 = [x * Math.cos(yaw) - z * Math.sin(yaw), x * Math.sin(yaw) + z * Math.cos(yaw)];
  const half = (metres: number) => Math.max(snapped(Math.abs(metres)), 0.01);
  switch (shape.type) {
    case "box":
      return { type: "box", size: [length(2 * half(along[0])), shape.size[1], length(2 * half(along[1]))] };
    case "sphere":
    case "capsule":
    case "cylinder":
      return { ...shape, radius: length(half(Math.hypot(x, z) / Math.SQRT2)) };
    case "hull":
    case "mesh": {
      const [a, , b] = halfSize(shape);
      return scaled(shape, Math.max(0.05, Math.hypot(x, z) / Math.hypot(a, b)));
    }
  }
}
