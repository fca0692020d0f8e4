import { describe, expect, it } from "vitest";
import { damp, dampAngle, wrapAngle } from "../src/camera/damping";
import { commandsDiffer, mergeIntents, NO_INTENT, radialDeadZone, steer } from "../src/input/steering";

const intent = (right: number, forward: number, strafe = 0) => ({ right, forward, strafe, run: false });

describe("steer, relative to the camera", () => {
  it("walks where the camera looks", () => {
    expect(steer(intent(0, 1), "camera", 0.7)).toMatchObject({ forward: 1, direction: 0.7, turn: 0, strafe: 0 });
  });

  it("turns right for a stick to the right: a smaller heading", () => {
    expect(steer(intent(1, 0), "camera", 0).direction).toBeCloseTo(-Math.PI / 2, 12);
    expect(steer(intent(-1, 0), "camera", 0).direction).toBeCloseTo(Math.PI / 2, 12);
  });

  it("backs up facing away for a stick within 45 degrees of straight back", () => {
    expect(steer(intent(0, -1), "camera", 2)).toMatchObject({ forward: -1, strafe: -0, direction: null });
    const diagonal = steer(intent(-Math.SQRT1_2, -Math.SQRT1_2), "camera", 2);
    expect(diagonal.direction).toBeNull();
    expect(diagonal.strafe).toBeCloseTo(Math.SQRT1_2, 12);
    expect(diagonal.forward).toBeCloseTo(-Math.SQRT1_2, 12);
    expect(steer(intent(-0.9, -0.2), "camera", 0).direction).not.toBeNull();
  });

  it("keeps the headings wrapped", () => {
    for (let heading = -20; heading < 20; heading += 0.37) {
      const direction = steer(intent(0.8, 0.5), "camera", heading).direction ?? NaN;
      expect(Math.abs(direction)).toBeLessThanOrEqual(Math.PI + 1e-12);
    }
  });

  it("steps aside without turning for the strafe keys", () => {
    expect(steer(intent(0, 0, 1), "camera", 1)).toMatchObject({ strafe: 1, direction: null });
  });
});

describe("steer, as a tank", () => {
  it("turns the body with left and right", () => {
    expect(steer(intent(-1, 0), "tank", 3)).toMatchObject({ turn: 1, forward: 0, direction: null });
    expect(steer(intent(0, -1), "tank", 3)).toMatchObject({ forward: -1 });
  });
});

describe("sticks", () => {
  it("has a radial dead zone that keeps the direction", () => {
    expect(radialDeadZone(0.1, 0.1)).toEqual([0, 0]);
    const [x, y] = radialDeadZone(0.3, 0.4);
    expect(Math.atan2(y, x)).toBeCloseTo(Math.atan2(0.4, 0.3), 12);
    expect(Math.hypot(...radialDeadZone(0.9, 0.9))).toBeCloseTo(1, 12);
  });

  it("merges devices inside the unit disc", () => {
    const merged = mergeIntents(intent(1, 1), intent(0, 1));
    expect(Math.hypot(merged.right, merged.forward)).toBeCloseTo(1, 12);
    expect(mergeIntents(NO_INTENT, NO_INTENT)).toEqual(NO_INTENT);
  });
});

describe("commandsDiffer", () => {
  it("ignores noise and sees a release", () => {
    const walking = steer(intent(0, 1), "camera", 0);
    expect(commandsDiffer(walking, steer(intent(0, 1), "camera", 0.0001))).toBe(false);
    expect(commandsDiffer(walking, steer(NO_INTENT, "camera", 0))).toBe(true);
  });
});

describe("damping", () => {
  it("does not depend on the frame rate", () => {
    let twice = damp(1, 5, 0.3, 0.1);
    twice = damp(twice, 5, 0.3, 0.1);
    expect(twice).toBeCloseTo(damp(1, 5, 0.3, 0.2), 12);
    expect(damp(0, 1, 0.5, 0.5)).toBeCloseTo(0.5, 12);
  });

  it("takes the short way round", () => {
    expect(wrapAngle(dampAngle(3.0, -3.0, 0.1, 10) + 3.0)).toBeCloseTo(0, 6);
    expect(dampAngle(3.0, -3.0, 0.1, 0.1)).toBeGreaterThan(3.0);
  });
});
