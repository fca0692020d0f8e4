/**
 * From sticks and keys to a command: pure functions, no browser in them.
 *
 * Headings are radians about +Y, 0 faces +Z, positive turns left; a stick's x is to the right, its y forward.
 */

import { wrapAngle } from "../camera/damping";

/** What the user's hands say in one moment; each number lies in [-1, 1]. */
export interface Intent {
  readonly right: number;
  readonly forward: number;
  /** Explicit side step, positive to the left. */
  readonly strafe: number;
  readonly run: boolean;
}

/** What goes to the server; the same fields as the Python `Command`. */
export interface Command {
  readonly forward: number;
  readonly strafe: number;
  readonly turn: number;
  readonly direction: number | null;
  readonly run: boolean;
}

export type SteeringMode = "camera" | "tank";

export const NO_INTENT: Intent = { right: 0, forward: 0, strafe: 0, run: false };

/** Half of the sector behind, in which a camera-relative stick backs up instead of turning round. */
const BACKING_SECTOR = Math.PI / 4 + 1e-6;

/** A radial dead zone: 0 inside, then rising from 0 to 1 along the stick's own direction. */
export function radialDeadZone(x: number, y: number, dead = 0.18, full = 0.95): [number, number] {
  const size = Math.hypot(x, y);
  if (size <= dead) return [0, 0];
  const scale = Math.min((size - dead) / (full - dead), 1) / size;
  return [x * scale, y * scale];
}

/** Adds two intents and keeps the stick inside the unit disc. */
export function mergeIntents(a: Intent, b: Intent): Intent {
  const right = a.right + b.right;
  const forward = a.forward + b.forward;
  const size = Math.max(1, Math.hypot(right, forward));
  return {
    right: right / size,
    forward: forward / size,
    strafe: Math.max(-1, Math.min(1, a.strafe + b.strafe)),
    run: a.run || b.run,
  };
}

/** The intent as a command; `cameraHeading` is where the camera looks. */
export function steer(intent: Intent, mode: SteeringMode, cameraHeading: number): Command {
  if (mode === "tank" || intent.strafe !== 0) return bodyCommand(intent);
  const size = Math.min(1, Math.hypot(intent.right, intent.forward));
  if (size === 0) return { forward: 0, strafe: 0, turn: 0, direction: null, run: intent.run };
  const angle = Math.atan2(intent.right, intent.forward);
  if (Math.PI - Math.abs(angle) <= BACKING_SECTOR) {
    return { forward: intent.forward, strafe: -intent.right, turn: 0, direction: null, run: intent.run };
  }
  return { forward: size, strafe: 0, turn: 0, direction: wrapAngle(cameraHeading - angle), run: intent.run };
}

/** Forward and back along the body; left and right turn it. */
function bodyCommand(intent: Intent): Command {
  return {
    forward: intent.forward, strafe: intent.strafe, turn: -intent.right, direction: null, run: intent.run,
  };
}

/** Whether two commands differ enough to be worth sending. */
export function commandsDiffer(a: Command, b: Command): boolean {
  if (a.run !== b.run || (a.direction === null) !== (b.direction === null)) return true;
  const step = Math.max(
    Math.abs(a.forward - b.forward), Math.abs(a.strafe - b.strafe), Math.abs(a.turn - b.turn),
    a.direction !== null && b.direction !== null ? Math.abs(wrapAngle(a.direction - b.direction)) : 0,
  );
  return step > 0.004;
}
