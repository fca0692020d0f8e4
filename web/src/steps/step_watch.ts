/** Tells when a foot comes down. */

import { POSE_FLAGS, type PoseFrame } from "../generated/messages";

/** The speed of a step on the spot, m/s; turning counts as so much a radian. */
const LIGHT = 0.2;
const TURNING = 0.25;
const FEET = POSE_FLAGS.left | POSE_FLAGS.right;

export type Foot = "left" | "right";

export interface Step {
  /** That came down. */
  readonly feet: readonly Foot[];
  /** m/s */
  readonly speed: number;
}

export class StepWatch {
  private epoch = NaN;
  private standing: number = FEET;

  /** The step that came down since the last look; null if none did. */
  update({ epoch, flags, forward, lateral, turn }: Pick<PoseFrame, "epoch" | "flags" | "forward" | "lateral" | "turn">): Step | null {
    const before = epoch === this.epoch ? this.standing : FEET;
    this.epoch = epoch;
    this.standing = flags & FEET;
    const down = this.standing & ~before;
    if (down === 0) return null;
    const feet = (["left", "right"] as const).filter((foot) => (down & POSE_FLAGS[foot]) !== 0);
    return { feet, speed: Math.max(Math.hypot(forward, lateral) + TURNING * Math.abs(turn), LIGHT) };
  }
}
