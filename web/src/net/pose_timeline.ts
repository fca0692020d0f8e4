/** The pose frames received lately, and the pose between two of them at any moment. */

import type { PoseFrame } from "../generated/messages";
import { slerpInto } from "./slerp";

const CAPACITY = 64;

/** A pose to show: the scalars of a frame, and the interpolated arrays (reused from call to call). */
export interface ShownPose extends PoseFrame {
  /** The pose is held because nothing newer has come. */
  starved: boolean;
}

const BLENDED = [
  "time", "simTime", "x", "y", "z", "heading", "forward", "lateral", "turn", "gait", "hipsX", "hipsY", "hipsZ",
] as const;

export class PoseTimeline {
  private frames: PoseFrame[] = [];

  /** The newest frame, or null before the first. */
  get newest(): PoseFrame | null {
    return this.frames[this.frames.length - 1] ?? null;
  }

  /** Whether nothing has been received yet (or since `clear`). */
  get empty(): boolean {
    return this.frames.length === 0;
  }

  clear(): void {
    this.frames = [];
  }

  /** Adds a frame; one that is older than the newest is dropped. */
  push(frame: PoseFrame): void {
    const newest = this.newest;
    if (newest && frame.time <= newest.time) return;
    this.frames.push(frame);
    if (this.frames.length > CAPACITY) this.frames.shift();
  }

  /** The pose at the server's `time`; null before the first frame. Never extrapolates. */
  sample(time: number): ShownPose | null {
    const newest = this.newest;
    const oldest = this.frames[0];
    if (!newest || !oldest) return null;
    if (time >= newest.time) return { ...newest, starved: time > newest.time };
    if (time <= oldest.time) return { ...oldest, starved: false };
    let after = this.frames.length - 1;
    while (after > 1 && (this.frames[after - 1] as PoseFrame).time > time) after--;
    return between(this.frames[after - 1] as PoseFrame, this.frames[after] as PoseFrame, time);
  }
}

/** The pose at `time` between two frames; the later one's flags; no blending across a jump. */
export function between(a: PoseFrame, b: PoseFrame, time: number): ShownPose {
  const share = Math.min(1, Math.max(0, (time - a.time) / (b.time - a.time)));
  const jump = a.epoch !== b.epoch || a.avatarRevision !== b.avatarRevision || a.jointCount !== b.jointCount;
  if (jump) return { ...(share < 1 ? a : b), starved: false };
  const pose: ShownPose = { ...(share < 0.5 ? a : b), starved: false };
  for (const name of BLENDED) pose[name] = a[name] + (b[name] - a[name]) * share;
  pose.rotations = new Float32Array(a.rotations.length);
  for (let at = 0; at < a.rotations.length; at += 4) slerpInto(pose.rotations, at, a.rotations, b.rotations, share);
  if (a.capsules.length === b.capsules.length) {
    pose.capsules = a.capsules.map((value, i) => value + ((b.capsules[i] ?? value) - value) * share);
  }
  return pose;
}
