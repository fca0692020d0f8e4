/** Gamepads with the standard mapping; they may come and go at any time. */

import type { Action } from "./keyboard";
import { NO_INTENT, radialDeadZone, type Intent } from "./steering";

/** Buttons of the standard mapping and what they do. */
const BUTTON_ACTIONS: readonly (readonly [number, Action])[] = [
  [2, "assist"], [3, "cameraMode"], [8, "reset"], [9, "pause"], [11, "recenter"], [12, "overlays"], [13, "slow"],
  [15, "step"],
];
const RUN_BUTTONS = [0, 10, 7] as const;

/** One reading: the stick, the look stick (right and down positive) and the buttons that went down. */
export interface GamepadReading {
  readonly intent: Intent;
  readonly look: readonly [number, number];
  readonly pressed: readonly Action[];
}

const NOTHING: GamepadReading = { intent: NO_INTENT, look: [0, 0], pressed: [] };

export class Gamepads {
  private down = new Set<number>();

  /** Reads the first connected standard gamepad. */
  poll(): GamepadReading {
    const pad = navigator.getGamepads?.().find((p) => p?.connected && p.mapping === "standard");
    if (!pad) {
      this.down.clear();
      return NOTHING;
    }
    const [right, back] = radialDeadZone(pad.axes[0] ?? 0, pad.axes[1] ?? 0);
    const look = radialDeadZone(pad.axes[2] ?? 0, pad.axes[3] ?? 0);
    const isDown = (button: number) => pad.buttons[button]?.pressed ?? false;
    const pressed = BUTTON_ACTIONS.filter(([b]) => isDown(b) && !this.down.has(b)).map(([, action]) => action);
    this.down = new Set(BUTTON_ACTIONS.map(([b]) => b).filter(isDown));
    const strafe = (isDown(4) ? 1 : 0) - (isDown(5) ? 1 : 0);
    return {
      intent: { right, forward: back === 0 ? 0 : -back, strafe, run: RUN_BUTTONS.some(isDown) },
      look,
      pressed,
    };
  }
}
