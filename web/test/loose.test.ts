import { describe, expect, it } from "vitest";
import type { Pushed, SceneMessage } from "../src/generated/messages";
import { Hand } from "../src/pushing/hand";
import { LooseThings } from "../src/stage/loose";
import { boxAt } from "../src/stage/moving";

const FORM = { shape: "box", size: [1, 1, 1], corners: [], triangles: [] };
const SCENE = { obstacles: [{ name: "crate", form: FORM, color: "" }, { name: "ball", form: FORM, color: "" }], moving: [], pushable: [0, 1] } as unknown as SceneMessage;

const pushed = (time: number, x: number, epoch = 1): Pushed => ({ type: "pushed", obstacle: 1, epoch, time, center: [x, 0.5, 0], yaw: 0 });

describe("what was pushed", () => {
  it("stands at any time where the server said, also between two pushes", () => {
    const things = new LooseThings(SCENE);
    for (let i = 0; i <= 6; i++) things.hear(pushed(i / 60, i));
    things.hear(pushed(10, 7));
    const track = things.loose.get(1);
    if (!track) throw new Error("nothing is loose");
    expect(boxAt(track, 3.5 / 60).center[0]).toBeCloseTo(3.5);
    expect(boxAt(track, 5).center[0]).toBeCloseTo(6);
    expect(boxAt(track, 20).center[0]).toBe(7);
    expect(track.name).toBe("ball");
  });

  it("is back with another epoch; the tracks of the walk before stay as they were", () => {
    const things = new LooseThings(SCENE);
    things.hear(pushed(1, 3));
    const before = things.loose;
    expect(things.backFor(1)).toBe(false);
    expect(things.backFor(2)).toBe(true);
    expect(things.loose.size).toBe(0);
    things.hear(pushed(0.5, 9, 2));
    expect(before.get(1)?.centers).toEqual([[3, 0.5, 0]]);
  });
});

describe("the hand", () => {
  it("tells no more than thirty places a second, the last one before it lets go", () => {
    const sent: unknown[] = [];
    const hand = new Hand((message) => sent.push(message));
    hand.take(3, [0, 0]);
    for (let i = 1; i <= 100; i++) {
      hand.move(i, 0);
      hand.update(i / 1000);
    }
    expect(sent.length).toBeLessThanOrEqual(4);
    hand.letGo();
    expect(sent.slice(-2)).toEqual([{ type: "push", obstacle: 3, place: [100, 0] }, { type: "push", obstacle: 3, place: null }]);
    hand.letGo();
    hand.update(9);
    expect(sent.length).toBeLessThanOrEqual(6);
  });
});
