/** Tells when a foot comes down. */

import { POSE_FLAGS, type PoseFrame } from "../generated/messages";

/** The speed of a step on the spot, m/s; turning counts as so much a radian. */
const LIGHT = 0.2;
const TURNING = 0.25;
const FEET = POSE_FLAGS.left | POSE_FLAGS.right;

export class StepWatch {
  private epoch = NaN;
  private standing: number = FEET;

  /** The speed of the step that came down since the last look, m/s; 0 if none did. */
  update({ epoch, flags, forward, lateral, turn }: Pick<PoseFrame, "epoch" | "flags" | "forward" | "lateral" | "turn">): number {
    const before = epoch === this.epoch ? this.standing : FEET;
    this.epoch = epoch;
    this.standing = flags & FEET;
    const down = this.standing & ~before;
    return down === 0 ? 0 : Math.max(Math.hypot(forward, lateral) + TURNING * Math.abs(turn), LIGHT);
  }
}
