/** Gamepads with the standard mapping; they may come and go at any time. */

import type { Action } from "./action";
import { NO_INTENT, radialDeadZone, type Intent } from "./steering";

/** What a button does: something once, or something while it is held. */
export type PadDeed = Action | "run" | "stepLeft" | "stepRight";

/** A button of the standard mapping: its number there, and how most pads call it. */
export interface PadButton {
  readonly number: number;
  readonly name: string;
  readonly deed: PadDeed;
}

export const PAD_BUTTONS: readonly PadButton[] = [
  { number: 0, name: "A", deed: "run" },
  { number: 7, name: "RT", deed: "run" },
  { number: 10, name: "L3", deed: "pause" },
  { number: 4, name: "LB", deed: "stepLeft" },
  { number: 5, name: "RB", deed: "stepRight" },
  { number: 11, name: "R3", deed: "recenter" },
  { number: 1, name: "B", deed: "nextView" },
  { number: 6, name: "LT", deed: "inset" },
  { number: 2, name: "X", deed: "assist" },
  { number: 3, name: "Y", deed: "cameraMode" },
  { number: 8, name: "Back", deed: "reset" },
  { number: 9, name: "Start", deed: "menu" },
  { number: 13, name: "↓", deed: "slow" },
  { number: 15, name: "→", deed: "step" },
  { number: 12, name: "↑", deed: "overlays" },
  { number: 14, name: "←", deed: "hideUi" },
];

const isHeldDeed = (deed: PadDeed): deed is Exclude<PadDeed, Action> => deed === "run" || deed === "stepLeft" || deed === "stepRight";

/** One reading: the stick, the look stick (right and down positive) and the buttons that went down. */
export interface GamepadReading {
  readonly intent: Intent;
  readonly look: readonly [number, number];
  readonly pressed: readonly Action[];
}

const NOTHING: GamepadReading = { intent: NO_INTENT, look: [0, 0], pressed: [] };

/** The first connected gamepad that has the standard mapping. */
export function connectedPad(): Gamepad | null {
  return navigator.getGamepads?.().find((pad) => pad?.connected && pad.mapping === "standard") ?? null;
}

/** Who works panels by the buttons of a pad. */
export interface PadPanels {
  /** @returns the buttons that it has used, which do nothing else */
  take(down: ReadonlySet<number>, fresh: ReadonlySet<number>, now: number): ReadonlySet<number>;
}

export class Gamepads {
  private down = new Set<number>();

  /** @param panels works what is up by buttons, before anything else does */
  constructor(private readonly panels: PadPanels | null = null) {}

  /** Reads the first connected standard gamepad. */
  poll(): GamepadReading {
    const pad = connectedPad();
    if (!pad) {
      this.down.clear();
      return NOTHING;
    }
    const [right, back] = radialDeadZone(pad.axes[0] ?? 0, pad.axes[1] ?? 0);
    const look = radialDeadZone(pad.axes[2] ?? 0, pad.axes[3] ?? 0);
    const down = new Set(pad.buttons.flatMap(({ pressed }, number) => (pressed ? [number] : [])));
    const fresh = new Set([...down].filter((number) => !this.down.has(number)));
    const used = this.panels?.take(down, fresh, performance.now() / 1000) ?? new Set<number>();
    const held = PAD_BUTTONS.filter(({ number }) => down.has(number) && !used.has(number));
    const pressed = held.flatMap(({ number, deed }) => (this.down.has(number) || isHeldDeed(deed) ? [] : [deed]));
    this.down = down;
    const on = (deed: PadDeed) => held.some((button) => button.deed === deed);
    const strafe = Number(on("stepLeft")) - Number(on("stepRight"));
    return { intent: { right, forward: back === 0 ? 0 : -back, strafe, run: on("run") }, look, pressed };
  }
}
