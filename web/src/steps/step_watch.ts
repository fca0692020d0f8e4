/** Tells when a foot comes down: twice in a stride, where its phase passes a whole or a half. */

import type { PoseFrame } from "../generated/messages";

/** Slower than this nobody steps, m/s; turning on the spot counts as so much a radian. */
const SLOWEST = 0.08;
const TURNING = 0.25;
/** A phase that goes on by more from one look to the next has jumped. */
const JUMP = 0.4;

export class StepWatch {
  private epoch = NaN;
  private phase = NaN;

  /** The speed of the step that came down since the last look, m/s; 0 if none did. */
  update({ epoch, gait, forward, lateral, turn }: Pick<PoseFrame, "epoch" | "gait" | "forward" | "lateral" | "turn">): number {
    const before = this.phase;
    const jumped = epoch !== this.epoch || Number.isNaN(before) || Math.abs(gait - before) > JUMP;
    this.epoch = epoch;
    this.phase = gait;
    const speed = Math.hypot(forward, lateral) + TURNING * Math.abs(turn);
    return !jumped && speed > SLOWEST && Math.floor(2 * gait) !== Math.floor(2 * before) ? speed : 0;
  }
}
