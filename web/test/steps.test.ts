import { describe, expect, it } from "vitest";
import type { SceneMessage } from "../src/generated/messages";
import { stepTone } from "../src/steps/step_sound";
import { StepWatch } from "../src/steps/step_watch";
import { groundAt } from "../src/steps/steps";

const walking = { epoch: 1, forward: 1.1, lateral: 0, turn: 0 };

describe("steps", () => {
  it("come down twice in a stride, forwards and backwards, however often one looks", () => {
    for (const looks of [7, 23, 60]) {
      for (const way of [1, -1]) {
        const watch = new StepWatch();
        let count = 0;
        for (let i = 0; i <= 10 * looks; i++) if (watch.update({ ...walking, gait: 0.1 + (way * i) / looks }) > 0) count++;
        expect(count).toBe(20);
      }
    }
  });

  it("are none while one stands, and none across a jump", () => {
    const watch = new StepWatch();
    watch.update({ ...walking, gait: 0.4 });
    expect(watch.update({ ...walking, epoch: 2, gait: 0.6 })).toBe(0);
    expect(watch.update({ ...walking, epoch: 2, gait: 7.2 })).toBe(0);
    expect(watch.update({ ...walking, epoch: 2, forward: 0, gait: 7.6 })).toBe(0);
    expect(watch.update({ ...walking, epoch: 2, gait: 8.01 })).toBe(0);
  });

  it("are louder when faster, and duller and quieter on the field", () => {
    expect(stepTone(2, "hard").loudness).toBeGreaterThan(stepTone(1, "hard").loudness);
    expect(stepTone(1, "soft").loudness).toBeLessThan(stepTone(1, "hard").loudness);
    expect(stepTone(1, "soft").pitch).toBeLessThan(stepTone(1, "hard").pitch);
    expect(stepTone(99, "hard").loudness).toBeLessThan(0.2);
  });

  it("know the ground", () => {
    const scene = { ground: { center: [0, 4], size: [6, 10] } } as unknown as SceneMessage;
    expect([groundAt(scene, 2.9, 8.9), groundAt(scene, 3.1, 4), groundAt(scene, 0, -1.1), groundAt(null, 0, 0)])
      .toEqual(["hard", "soft", "soft", "hard"]);
  });
});
