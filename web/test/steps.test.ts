import { describe, expect, it } from "vitest";
import { POSE_FLAGS, type SceneMessage } from "../src/generated/messages";
import { stepTone } from "../src/steps/step_sound";
import { StepWatch } from "../src/steps/step_watch";
import { groundAt } from "../src/steps/steps";

const { left, right } = POSE_FLAGS;
const walking = { epoch: 1, forward: 1.1, lateral: 0, turn: 0 };

describe("steps", () => {
  it("are heard where a foot comes down, and only there", () => {
    const watch = new StepWatch();
    const heard = [left | right, left, left, left | right, right, left | right, left | right].map((flags) => watch.update({ ...walking, flags })?.feet ?? []);
    expect(heard).toEqual([[], [], [], ["right"], [], ["left"], []]);
  });

  it("are light on the spot, and none across a jump", () => {
    const watch = new StepWatch();
    watch.update({ ...walking, flags: left });
    expect(watch.update({ ...walking, epoch: 2, flags: left | right })).toBeNull();
    watch.update({ ...walking, epoch: 2, flags: right });
    expect(watch.update({ ...walking, epoch: 2, forward: 0, flags: left | right })?.speed).toBeGreaterThan(0);
    watch.update({ ...walking, epoch: 2, flags: right });
    expect(watch.update({ ...walking, epoch: 2, forward: 2, flags: left | right })?.speed).toBeGreaterThan(1.9);
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
