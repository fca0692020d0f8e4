/** A plan as the stage draws scenes, so that one sees it while it is built. */

import { Vector3 } from "three";
import { ConvexHull } from "three/addons/math/ConvexHull.js";
import type { Form, MovingObstacle, Obstacle, SceneMessage } from "../generated/messages";
import type { Plan, Shape, Thing, Vec3 } from "./plan";
import { halfSize } from "./shapes";

/** The message that the server would send of it, but for its name. */
export function previewOf({ title, description, ground, start, finish, things, tour }: Plan): SceneMessage {
  return {
    type: "scene", name: "", title, description, ground: { center: [...ground.center], size: [...ground.size] }, model: null,
    obstacles: things.filter(({ track }) => track.length === 0).map(standing),
    pushable: [],
    moving: things.filter(({ track }) => track.length > 0).map(moving),
    start, finish, tour: tour.map((stop) => ({ ...stop, position: [stop.x, stop.z] })),
  };
}

function standing({ name, color, shape, center, rotation }: Thing): Obstacle {
  return { name, color, form: formOf(shape), center: [...center], rotation: [...rotation] };
}

function moving({ name, color, shape, track, repeat }: Thing): MovingObstacle {
  const keys = repeat === "loop" ? [...track, ...track.slice(0, 1)] : track;
  const times = keys.map((_, i) => track.slice(0, i).reduce((sum, { seconds }) => sum + seconds, 0));
  return { name, color, form: formOf(shape), times, centers: keys.map(({ center }) => [...center]), yaws: keys.map(({ yaw }) => yaw), repeat };
}

function formOf(shape: Shape): Form {
  const [x, y, z] = halfSize(shape);
  const size: Form["size"] = [2 * x, 2 * y, 2 * z];
  if (shape.type === "hull") return { shape: "hull", size, ...surfaceOf(shape.points) };
  if (shape.type === "mesh") return { shape: "mesh", size, corners: shape.vertices.map(copy), triangles: shape.faces.map(copy) };
  return { shape: shape.type, size, corners: [], triangles: [] };
}

/** The corners of a convex hull and its triangles. */
function surfaceOf(points: readonly Vec3[]): Pick<Form, "corners" | "triangles"> {
  const corners: [number, number, number][] = [];
  const triangles: [number, number, number][] = [];
  for (const face of new ConvexHull().setFromPoints(points.map((point) => new Vector3(...point))).faces) {
    const at = corners.length;
    for (let edge = face.edge, i = 0; i < 3; edge = edge.next, i++) corners.push(edge.head().point.toArray());
    triangles.push([at, at + 1, at + 2]);
  }
  return { corners, triangles };
}

function copy([x, y, z]: Vec3): [number, number, number] {
  return [x, y, z];
}
