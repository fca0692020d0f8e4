import { describe, expect, it } from "vitest";
import { backwards, NO_SHIFT, roomierView } from "../src/camera/roomier_view";
import { cameraReach, prepareBox, type OrientedBox } from "../src/camera/spring_arm";

const upright = (center: OrientedBox["center"], halfSize: OrientedBox["halfSize"]) =>
  prepareBox({ center, rotation: [0, 0, 0, 1], halfSize });

const view = (boxes: ReturnType<typeof upright>[]) =>
  roomierView(
    ({ yaw, pitch }) => cameraReach({ all: boxes, walls: boxes }, [0, 1.5, 0], backwards(yaw, 0.3 + pitch), 4, 0.14),
    0.3, 4, NO_SHIFT, { pitch: [-0.2, 1.3], wide: false },
  );

describe("roomierView", () => {
  it("leaves the view alone where there is room", () => {
    expect(view([])).toEqual(NO_SHIFT);
    expect(view([upright([0, 1, -3.5], [1, 2, 0.1])])).toEqual(NO_SHIFT);
  });

  it("looks over a low wall close behind", () => {
    const shift = view([upright([0, 0.9, -0.8], [6, 1.1, 0.1])]);
    expect(shift.pitch).toBeGreaterThan(0.1);
    expect(shift.yaw).toBe(0);
  });

  it("looks from below a beam close behind", () => {
    expect(view([upright([0, 2.6, -0.9], [6, 0.95, 0.3])]).pitch).toBeLessThan(-0.1);
  });

  it("looks past a post close behind", () => {
    expect(Math.abs(view([upright([0, 2, -0.8], [0.12, 4, 0.12])]).yaw)).toBeGreaterThan(0.2);
  });
});
