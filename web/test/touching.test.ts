import { describe, expect, it } from "vitest";
import { distanceToBox, prepareBox } from "../src/camera/spring_arm";
import { capsuleTouches, segmentBoxDistance } from "../src/overlays/touching";

describe("segmentBoxDistance", () => {
  it("equals a dense sampling of the segment", () => {
    for (let trial = 0; trial < 200; trial++) {
      const wave = (k: number) => Math.sin(trial * 12.9898 + k * 78.233);
      const norm = Math.hypot(wave(1), wave(2), wave(3), wave(4));
      const box = prepareBox({
        center: [wave(5), wave(6), wave(7)],
        rotation: [wave(1) / norm, wave(2) / norm, wave(3) / norm, wave(4) / norm],
        halfSize: [0.1 + Math.abs(wave(8)), 0.1 + Math.abs(wave(9)), 0.1 + Math.abs(wave(10))],
      });
      const segment = [11, 12, 13, 14, 15, 16].map((k) => 2 * wave(k));
      const [ax = 0, ay = 0, az = 0, bx = 0, by = 0, bz = 0] = segment;
      let nearest = Infinity;
      for (let t = 0; t <= 1; t += 1 / 2000) {
        nearest = Math.min(nearest, distanceToBox(box, ax + (bx - ax) * t, ay + (by - ay) * t, az + (bz - az) * t));
      }
      expect(segmentBoxDistance(box, segment, 0)).toBeLessThanOrEqual(nearest + 1e-9);
      expect(segmentBoxDistance(box, segment, 0)).toBeGreaterThan(nearest - 2e-3);
    }
  });
});

describe("capsuleTouches", () => {
  it("tells touching from near", () => {
    const box = prepareBox({ center: [0, 0, 0], rotation: [0, 0, 0, 1], halfSize: [1, 1, 1] });
    expect(capsuleTouches([box], [1.2, -3, 0, 1.2, 3, 0], 0, 0.21)).toBe(true);
    expect(capsuleTouches([box], [1.2, -3, 0, 1.2, 3, 0], 0, 0.19)).toBe(false);
    expect(capsuleTouches([], [0, 0, 0, 0, 1, 0], 0, 1)).toBe(false);
  });
});
