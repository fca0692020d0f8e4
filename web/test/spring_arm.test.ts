import { describe, expect, it } from "vitest";
import { cameraReach, distanceToBox, distanceToBoxes, freeReach, isWall, prepareBox, type OrientedBox,  } from "../src/camera/spring_arm";
import type { Vec3 } from "../src/camera/vectors";

/** A small deterministic generator (mulberry32), so that a failure repeats. */
function random(seed: number): () => number {
  let state = seed;
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

function unit(values: number[]): number[] {
  const norm = Math.hypot(...values);
  return values.map((v) => v / norm);
}

function randomBox(next: () => number): OrientedBox {
  return {
    center: [next() * 6 - 3, next() * 3, next() * 6 - 3],
    rotation: unit([next() - 0.5, next() - 0.5, next() - 0.5, next() - 0.5]) as [number, number, number, number],
    halfSize: [0.05 + next(), 0.05 + next(), 0.05 + next()],
  };
}

describe("distanceToBox", () => {
  it("measures faces, edges and corners of a turned box", () => {
    const quarter = Math.SQRT1_2;
    const box = prepareBox({ center: [1, 0, 0], rotation: [0, quarter, 0, quarter], halfSize: [2, 1, 0.5] });
    expect(distanceToBox(box, 1, 0, 0)).toBe(0);
    expect(distanceToBox(box, 2.5, 0, 0)).toBeCloseTo(1, 12);
    expect(distanceToBox(box, 1, 0, 3)).toBeCloseTo(1, 12);
    expect(distanceToBox(box, 4.5, 5, 0)).toBeCloseTo(5, 12);
  });
});

describe("freeReach", () => {
  it("reaches all the way where nothing stands", () => {
    expect(freeReach([], [0, 1.5, 0], [0, 0, -1], 4, 0.2)).toBe(4);
  });

  it("stops one radius before a wall", () => {
    const wall = prepareBox({ center: [0, 1, -3], rotation: [0, 0, 0, 1], halfSize: [5, 1, 0.5] });
    expect(freeReach([wall], [0, 1.5, 0], [0, 0, -1], 6, 0.2)).toBeCloseTo(2.3, 3);
  });

  it("stays above the ground", () => {
    const direction = unit([0, -1, -1]) as [number, number, number];
    const reach = freeReach([], [0, 1.5, 0], direction, 9, 0.2);
    expect(1.5 + direction[1] * reach).toBeCloseTo(0.2, 9);
  });

  it("never enters a box and never gives up space that a fine march would find", () => {
    const next = random(7);
    for (let trial = 0; trial < 300; trial++) {
      const boxes = Array.from({ length: 6 }, () => prepareBox(randomBox(next)));
      const origin: Vec3 = [next() * 4 - 2, 1 + next(), next() * 4 - 2];
      const direction = unit([next() - 0.5, next() * 0.5, next() - 0.5]) as [number, number, number];
      const room = distanceToBoxes(boxes, ...origin);
      if (room === 0) {
        expect(freeReach(boxes, origin, direction, 5, 0.2)).toBe(0);
        continue;
      }
      const probe = (t: number) => Math.min(0.2, room * 0.9 + 0.5 * t);
      const reach = freeReach(boxes, origin, direction, 5, 0.2);
      const at = (t: number) =>
        distanceToBoxes(boxes, origin[0] + direction[0] * t, origin[1] + direction[1] * t, origin[2] + direction[2] * t);
      for (let t = 0; t <= reach; t += 0.01) expect(at(t)).toBeGreaterThanOrEqual(probe(t) - 1e-9);
      if (reach < 5) expect(at(reach)).toBeLessThan(probe(reach) + 0.02);
    }
  });
});

describe("cameraReach", () => {
  it("looks past furniture but not through walls, and is inside of neither", () => {
    const still: OrientedBox["rotation"] = [0, 0, 0, 1];
    const post = prepareBox({ center: [0, 1, -1], rotation: still, halfSize: [0.1, 1, 0.1] });
    const wall = prepareBox({ center: [0, 1, -1], rotation: still, halfSize: [3, 1.5, 0.1] });
    expect([isWall(post), isWall(wall)]).toEqual([false, true]);
    const reach = (boxes: (typeof post)[], wanted: number) =>
      cameraReach({ all: boxes, walls: boxes.filter((box) => isWall(box)) }, [0, 1.5, 0], [0, 0, -1], wanted, 0.16);
    expect(reach([post], 4)).toBe(4);
    expect(reach([wall], 4)).toBeCloseTo(0.74, 2);
    expect(reach([post], 1)).toBeLessThanOrEqual(0.7401);
    expect(reach([post], 1)).toBeGreaterThan(0.6);
  });

  it("never ends inside a box", () => {
    const next = random(11);
    for (let trial = 0; trial < 300; trial++) {
      const all = Array.from({ length: 6 }, () => prepareBox(randomBox(next)));
      const walls = all.filter((box) => isWall(box));
      const direction = unit([next() - 0.5, next() * 0.5, next() - 0.5]) as [number, number, number];
      const reach = cameraReach({ all, walls }, [0, 1.4, 0], direction, 4, 0.16);
      const end = [direction[0] * reach, 1.4 + direction[1] * reach, direction[2] * reach] as const;
      if (reach > 0) expect(distanceToBoxes(all, ...end)).toBeGreaterThan(0.159);
    }
  });
});
