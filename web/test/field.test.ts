import { describe, expect, it } from "vitest";
import { FIELD_REACH, FIELD_TILE, fieldMiddle, HAZE } from "../src/stage/field";

describe("the open field", () => {
  it("reaches into the haze wherever one walks, and its pattern stays in place", () => {
    for (let v = -5000; v <= 5000; v += 7.3) {
      const middle = fieldMiddle(v);
      expect(FIELD_REACH - Math.abs(v - middle)).toBeGreaterThan(HAZE[1] * 1.5);
      expect(Math.abs(middle % FIELD_TILE)).toBe(0);
    }
  });
});
