/** What is being built: a scene as build mode holds it. It never changes; every edit makes another one. */

export type Vec2 = readonly [number, number];
export type Vec3 = readonly [number, number, number];
/** x, y, z, w. */
export type Turn = readonly [number, number, number, number];

export type Shape =
  | { readonly type: "box"; readonly size: Vec3 }
  | { readonly type: "sphere"; readonly radius: number }
  | { readonly type: "capsule"; readonly radius: number; readonly length: number }
  | { readonly type: "cylinder"; readonly radius: number; readonly height: number }
  | { readonly type: "hull"; readonly points: readonly Vec3[] }
  | { readonly type: "mesh"; readonly vertices: readonly Vec3[]; readonly faces: readonly Vec3[] };

/** A key pose of a track. */
export interface Key {
  readonly center: Vec3;
  readonly yaw: number;
  /** Until the next. */
  readonly seconds: number;
}

export const REPEATS = ["loop", "pingpong", "once"] as const;
export type Repeat = (typeof REPEATS)[number];

/** An obstacle: it stands where it has no track. */
export interface Thing {
  readonly name: string;
  /** "#rrggbb", or "" for the page's choice. */
  readonly color: string;
  readonly shape: Shape;
  readonly center: Vec3;
  readonly rotation: Turn;
  readonly track: readonly Key[];
  readonly repeat: Repeat;
}

/** A place on the ground and a direction; 0 faces +Z, positive turns left. */
export interface Spot {
  readonly x: number;
  readonly z: number;
  readonly heading: number;
}

/** A stop of the guided tour; see `elbowroom/world/stops.py`. */
export interface TourStop {
  readonly x: number;
  readonly z: number;
  /** Of the floor there; null: the one that a way leads to. */
  readonly height: number | null;
  /** A camera's name; "" leaves it as it is. */
  readonly view: string;
  readonly say: string;
  readonly seconds: number;
}

export interface Plan {
  readonly title: string;
  readonly description: string;
  readonly ground: { readonly size: Vec2; readonly center: Vec2 };
  readonly start: Spot;
  readonly finish: Spot & { readonly width: number };
  readonly things: readonly Thing[];
  readonly tour: readonly TourStop[];
}

export const UPRIGHT: Turn = [0, 0, 0, 1];

/** Bare ground, five metres to walk. */
export function emptyPlan(title: string): Plan {
  return {
    title, description: "", ground: { size: [12, 14], center: [0, 3] }, start: { x: 0, z: 0, heading: 0 },
    finish: { x: 0, z: 6, heading: 0, width: 4 }, things: [], tour: [],
  };
}
