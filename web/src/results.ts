/** What a crossing came to, what was best before, and where to go next. */

import type { PoseFrame } from "./generated/messages";

/** Within so many metres of the start nothing has begun yet; the server counts alike. */
const AT_START = 0.3;
const STORE = "elbowroom.best";
const MOST_KEPT = 300;
const COURSE = /^gauntlet:(\d+):(\d+)$/;
const LARGEST_SEED = 2 ** 32 - 1;

/** The least distance to anything since the avatar set off from the start. */
export class LeastClearance {
  private least = Infinity;
  private epoch = -1;

  get value(): number {
    return this.least;
  }

  /** Notes a frame; `start` is where the scene begins. */
  add({ epoch, x, z, clearance }: Pick<PoseFrame, "epoch" | "x" | "z" | "clearance">, start: readonly [number, number]): void {
    const begins = epoch !== this.epoch || Math.hypot(x - start[0], z - start[1]) < AT_START;
    this.epoch = epoch;
    this.least = begins ? Infinity : Math.min(this.least, clearance);
  }
}

/** The best times of this browser, by scene and planner. */
export class BestTimes {
  constructor(private readonly storage: Pick<Storage, "getItem" | "setItem"> | null) {}

  /** Notes a time in seconds; the best before it, or null if it is the first. */
  note(scene: string, planner: string, seconds: number): number | null {
    const kept = this.read();
    const name = `${scene} ${planner}`;
    const before = kept.get(name) ?? null;
    kept.delete(name);
    kept.set(name, Math.min(seconds, before ?? Infinity));
    const newest = [...kept].slice(-MOST_KEPT);
    try {
      this.storage?.setItem(STORE, JSON.stringify(Object.fromEntries(newest)));
    } catch {
      return before; // a browser that stores nothing has no best times
    }
    return before;
  }

  private read(): Map<string, number> {
    try {
      const data: unknown = JSON.parse(this.storage?.getItem(STORE) ?? "{}");
      const entries = typeof data === "object" && data !== null ? Object.entries(data) : [];
      return new Map(entries.filter((entry): entry is [string, number] => Number.isFinite(entry[1])));
    } catch {
      return new Map();
    }
  }
}

/** Level and seed of a random course; null for other scenes. */
export function courseOf(scene: string): { readonly level: number; readonly seed: number } | null {
  const found = COURSE.exec(scene);
  return found ? { level: Number(found[1]), seed: Number(found[2]) } : null;
}

/** The name of a random course. */
export function courseName(level: number, seed: number): string {
  return `gauntlet:${level}:${Math.min(LARGEST_SEED, Math.max(0, Math.floor(seed)))}`;
}

/** The scene after this one: the next course of the level, or the next in the menu, round and round. */
export function nextScene(scene: string, offered: readonly string[]): string {
  const course = courseOf(scene);
  if (course) return courseName(course.level, course.seed >= LARGEST_SEED ? 0 : course.seed + 1);
  const places = offered.filter((name) => courseOf(name) === null);
  return places[(places.indexOf(scene) + 1) % places.length] ?? scene;
}
