/** The shapes that can be placed: how each begins, how large it is, and how it grows. */

import type { Shape, Vec3 } from "./plan";

/** What can be placed; meshes come from files only. */
export const KINDS = ["box", "sphere", "capsule", "cylinder", "hull"] as const;
export type Kind = (typeof KINDS)[number];

const SMALLEST = 0.01;
const LARGEST = 1000;

/** A new shape of a kind. */
export function fresh(kind: Kind): Shape {
  switch (kind) {
    case "box":
      return { type: "box", size: [0.6, 1.2, 0.4] };
    case "sphere":
      return { type: "sphere", radius: 0.3 };
    case "capsule":
      return { type: "capsule", radius: 0.15, length: 1 };
    case "cylinder":
      return { type: "cylinder", radius: 0.2, height: 1.4 };
    case "hull":
      return { type: "hull", points: wedge(0.4, 0.35, 0.4) };
  }
}

/** A ramp about its middle. */
function wedge(x: number, y: number, z: number): readonly Vec3[] {
  return [[-x, -y, -z], [x, -y, -z], [-x, -y, z], [x, -y, z], [-x, y, z], [x, y, z]];
}

/** Half the extents along its own axes of the box about its origin that holds it. */
export function halfSize(shape: Shape): Vec3 {
  switch (shape.type) {
    case "box":
      return [shape.size[0] / 2, shape.size[1] / 2, shape.size[2] / 2];
    case "sphere":
      return [shape.radius, shape.radius, shape.radius];
    case "capsule":
      return [shape.radius, shape.length / 2 + shape.radius, shape.radius];
    case "cylinder":
      return [shape.radius, shape.height / 2, shape.radius];
    case "hull":
      return reach(shape.points);
    case "mesh":
      return reach(shape.vertices);
  }
}

/** The same shape, larger or smaller. */
export function scaled(shape: Shape, factor: number): Shape {
  const grown = (points: readonly Vec3[]): readonly Vec3[] => points.map(([x, y, z]) => [x * factor, y * factor, z * factor]);
  switch (shape.type) {
    case "box":
      return { type: "box", size: [length(shape.size[0] * factor), length(shape.size[1] * factor), length(shape.size[2] * factor)] };
    case "sphere":
      return { type: "sphere", radius: length(shape.radius * factor) };
    case "capsule":
      return { type: "capsule", radius: length(shape.radius * factor), length: length(shape.length * factor) };
    case "cylinder":
      return { type: "cylinder", radius: length(shape.radius * factor), height: length(shape.height * factor) };
    case "hull":
      return { type: "hull", points: grown(shape.points) };
    case "mesh":
      return { ...shape, vertices: grown(shape.vertices) };
  }
}

/** A length that a scene may have, to the millimetre. */
export function length(metres: number): number {
  return Math.min(LARGEST, Math.max(SMALLEST, Math.round(metres * 1000) / 1000));
}

function reach(points: readonly Vec3[]): Vec3 {
  const most = (axis: 0 | 1 | 2) => Math.max(SMALLEST, ...points.map((point) => Math.abs(point[axis])));
  return [most(0), most(1), most(2)];
}
