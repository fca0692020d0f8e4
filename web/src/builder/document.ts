/** Between a plan and the JSON document of a scene (docs/scenes.md), as the server writes it: with a quaternion for every turn. */

import { UPRIGHT, type Key, type Plan, type Repeat, type Shape, type Thing, type TourStop, type Turn, type Vec2, type Vec3 } from "./plan";

type Written = Shape & { readonly name: string; readonly color?: string };
type Standing = Written & { readonly center: Vec3; readonly rotation?: Turn };
type WrittenStop = { readonly position: Vec2 | Vec3; readonly view: string; readonly say: string; readonly seconds: number };
type Moving = Written & { readonly repeat: Repeat; readonly track: readonly Key[] };

export interface SceneDocument {
  readonly format: "elbowroom-scene";
  readonly version: 1;
  readonly name: string;
  readonly title: string;
  readonly description: string;
  readonly ground: { readonly size: Vec2; readonly center: Vec2 };
  readonly start: { readonly position: Vec2; readonly heading: number };
  readonly finish: { readonly position: Vec2; readonly heading: number; readonly width: number };
  readonly obstacles: readonly Standing[];
  readonly moving?: readonly Moving[];
  readonly tour?: readonly WrittenStop[];
}

const NAME = 100;

/** The document of a plan. */
export function documentOf({ title, description, ground, start, finish, things, tour }: Plan): SceneDocument {
  const moving = things.filter(({ track }) => track.length > 0).map(movingOf);
  return {
    format: "elbowroom-scene", version: 1, name: nameOf(title), title, description, ground,
    start: { position: [start.x, start.z], heading: start.heading },
    finish: { position: [finish.x, finish.z], heading: finish.heading, width: finish.width },
    obstacles: things.filter(({ track }) => track.length === 0).map(standingOf),
    ...(moving.length > 0 ? { moving } : {}),
    ...(tour.length > 0 ? { tour: tour.map(writtenStop) } : {}),
  };
}

/** The plan of a document that the server has read. */
export function planOf(document: SceneDocument): Plan {
  const { title, description, ground, start, finish, obstacles, moving = [], tour = [] } = document;
  const [x, z] = start.position, [toX, toZ] = finish.position;
  const standing = obstacles.map(({ name, color = "", center, rotation = UPRIGHT, ...shape }): Thing =>
    ({ name, color, shape, center, rotation, track: [], repeat: "pingpong" }));
  const tracked = moving.map(({ name, color = "", repeat, track, ...shape }): Thing =>
    ({ name, color, shape, center: track[0]?.center ?? [0, 0, 0], rotation: UPRIGHT, track, repeat }));
  return {
    title, description, ground, start: { x, z, heading: start.heading },
    finish: { x: toX, z: toZ, heading: finish.heading, width: finish.width }, things: [...standing, ...tracked],
    tour: tour.map(stopOf),
  };
}

/** A short name for files and for `--scene`. */
export function nameOf(title: string): string {
  return title.normalize("NFC").trim().replace(/[^\p{L}\p{N}]+/gu, "-").replace(/^-|-$/g, "").slice(0, NAME) || "scene";
}

function writtenStop({ x, z, height, view, say, seconds }: TourStop): WrittenStop {
  return { position: height === null ? [x, z] : [x, height, z], view, say, seconds };
}

function stopOf({ position, view, say, seconds }: WrittenStop): TourStop {
  const [x, z, height] = position.length === 3 ? [position[0], position[2], position[1]] : [...position, null];
  return { x, z, height, view, say, seconds };
}

function standingOf({ name, color, shape, center, rotation }: Thing): Standing {
  return { ...shape, name, center, ...(shape.type === "sphere" ? {} : { rotation }), ...(color ? { color } : {}) };
}

function movingOf({ name, color, shape, track, repeat }: Thing): Moving {
  return { ...shape, name, repeat, track, ...(color ? { color } : {}) };
}
