import { describe, expect, it } from "vitest";
import type { MovingObstacle } from "../src/generated/messages";
import { boxAt } from "../src/stage/moving";

const box = (repeat: MovingObstacle["repeat"]): MovingObstacle => ({
  name: "box", form: { shape: "box", size: [1, 2, 3], corners: [], triangles: [] }, times: [0, 2, 3], centers: [[0, 1, 0], [2, 1, 0], [2, 1, 1]], yaws: [0, 0.4, -0.3], repeat, color: "",
});

describe("boxAt", () => {
  it.each([
    ["once", 1, 1, 0, 0.2],
    ["once", 9, 2, 1, -0.3],
    ["loop", 4, 1, 0, 0.2],
    ["pingpong", 3.5, 2, 0.5, 0.05],
    ["pingpong", 7, 1, 0, 0.2],
  ] as const)("%s at %d s", (repeat, time, x, z, yaw) => {
    const { center, rotation, halfSize } = boxAt(box(repeat), time);
    expect(center[0]).toBeCloseTo(x, 9);
    expect(center[2]).toBeCloseTo(z, 9);
    expect(2 * Math.asin(rotation[1])).toBeCloseTo(yaw, 9);
    expect(halfSize).toEqual([0.5, 1, 1.5]);
  });
});
