import { afterEach, describe, expect, it, vi } from "vitest";
import { Gamepads, PAD_BUTTONS } from "../src/input/gamepad";

function pad(...down: number[]): void {
  const buttons = Array.from({ length: 17 }, (_, i) => ({ pressed: down.includes(i) }));
  vi.stubGlobal("navigator", { getGamepads: () => [null, { connected: true, mapping: "standard", axes: [0, -1, 0, 0], buttons }] });
}

afterEach(() => vi.unstubAllGlobals());

describe("a gamepad", () => {
  it("does once what a button asks for, and holds what is held", () => {
    const pads = new Gamepads();
    pad(2, 4, 7);
    expect(pads.poll()).toEqual({ intent: { right: 0, forward: 1, strafe: 1, run: true }, look: [0, 0], pressed: ["assist"] });
    expect(pads.poll().pressed).toEqual([]);
    pad(5);
    expect(pads.poll().intent).toMatchObject({ strafe: -1, run: false });
    pad(2);
    expect(pads.poll().pressed).toEqual(["assist"]);
  });

  it("has no button with two deeds", () => {
    expect(new Set(PAD_BUTTONS.map(({ number }) => number)).size).toBe(PAD_BUTTONS.length);
  });

  it("is at rest when it is gone", () => {
    vi.stubGlobal("navigator", { getGamepads: () => [null] });
    expect(new Gamepads().poll().intent.forward).toBe(0);
  });
});
