import { describe, expect, it } from "vitest";
import { ghostShare } from "../src/overlays/ghost_share";

describe("ghosts of planned key frames", () => {
  it("leave the avatar in sight: none inside it, strongest one step ahead, weak far away", () => {
    expect(ghostShare(0)).toBe(0);
    expect(ghostShare(0.7)).toBe(1);
    const far = [1, 1.5, 2, 3, 5].map(ghostShare);
    expect([...far].sort((a, b) => b - a)).toEqual(far);
    expect(far.at(-1)).toBeCloseTo(0.3);
  });
});
