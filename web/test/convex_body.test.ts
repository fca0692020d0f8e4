import { describe, expect, it } from "vitest";
import { convexBody } from "../src/camera/convex_body";
import { distanceToBounds, distanceToBox, prepareBox } from "../src/camera/spring_arm";
import type { Vec3 } from "../src/camera/vectors";
import type { Form } from "../src/generated/messages";

const none = { corners: [], triangles: [] };
const FORMS: Record<string, Form> = {
  sphere: { shape: "sphere", size: [1, 1, 1], ...none },
  capsule: { shape: "capsule", size: [0.6, 2, 0.6], ...none },
  cylinder: { shape: "cylinder", size: [0.8, 1.2, 0.8], ...none },
  hull: {
    shape: "hull", size: [2, 2, 2],
    corners: [[1, 0, -0.7], [-1, 0, -0.7], [0, 1, 0.7], [0, -1, 0.7]],
    triangles: [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
  },
};
const PLACES: Vec3[] = [[2, 0.1, 0.3], [0.4, 1.9, -0.2], [-0.8, -1.4, 1.1], [0.01, 0, 0.02], [0, -3, 0], [0.3, 0.55, 0.3]];

function prepared(form: Form) {
  const [x, y, z] = form.size, body = convexBody(form);
  const box = { center: [0, 0, 0], rotation: [0, 0, 0, 1], halfSize: [x / 2, y / 2, z / 2] } as const;
  return prepareBox(body ? { ...box, body } : box);
}

describe("convexBody", () => {
  it("leaves boxes as they are", () => {
    expect(convexBody({ shape: "box", size: [1, 2, 3], ...none })).toBeUndefined();
  });

  it.each([
    ["sphere", [2, 0, 0], 1.5],
    ["sphere", [0.1, 0.2, 0], 0],
    ["capsule", [0, 1.5, 0], 0.5],
    ["capsule", [1.3, 0.5, 0], 1],
    ["cylinder", [1.4, 1.6, 0], Math.SQRT2],
    ["cylinder", [0.3, 0.2, 0.1], 0],
    ["hull", [0, 0, 0], 0],
    ["hull", [0, 0, -1.7], 1],
    ["hull", [3, 0, -0.7], 2],
  ] as const)("%s from %o", (name, [x, y, z], distance) => {
    expect(distanceToBox(prepared(FORMS[name] as Form), x, y, z)).toBeCloseTo(distance, 9);
  });

  it.each(Object.keys(FORMS))("%s is in its box, and the nearest point is nearest to itself", (name) => {
    const box = prepared(FORMS[name] as Form);
    for (const place of PLACES) {
      const found = box.body?.nearest(place) ?? place;
      expect(distanceToBox(box, ...found)).toBeCloseTo(0, 9);
      expect(distanceToBounds(box, ...found)).toBeCloseTo(0, 9);
      expect(distanceToBounds(box, ...place)).toBeLessThanOrEqual(distanceToBox(box, ...place) + 1e-9);
      // No point of the body on the way to any other is nearer.
      for (const other of PLACES) {
        const there = box.body?.nearest(other) ?? other;
        expect(Math.hypot(place[0] - there[0], place[1] - there[1], place[2] - there[2]))
          .toBeGreaterThanOrEqual(distanceToBox(box, ...place) - 1e-9);
      }
    }
  });
});
