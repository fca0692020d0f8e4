/** A walk that was kept: where, who, and every frame in the order of its own time. */

import { POSE_FLAGS, type AvatarMessage, type PoseFrame, type SceneMessage } from "../generated/messages";
import { between, type ShownPose } from "../net/pose_timeline";
import type { Loose } from "../stage/loose";

/** One step of simulated time, seconds. */
export const STEP = 1 / 60;

export interface Take {
  /** Unlike any other of this page. */
  readonly id: number;
  readonly scene: SceneMessage;
  /** What was pushed meanwhile. */
  readonly loose: Loose;
  readonly avatar: AvatarMessage;
  readonly planner: string;
  /** Where it comes from: the name of a file, or "" for a walk on this page. */
  readonly file: string;
  /** At least one; `time` is in seconds since the take began, strictly growing. */
  readonly frames: readonly PoseFrame[];
}

/** Seconds from the first frame to the last. */
export function durationOf({ frames }: Take): number {
  return (frames[frames.length - 1]?.time ?? 0) - (frames[0]?.time ?? 0);
}

/** Whether the avatar goes or turns in a frame. */
export function moves({ forward, lateral, turn }: PoseFrame): boolean {
  return Math.abs(forward) + Math.abs(lateral) + Math.abs(turn) > 0.01;
}

/** When the avatar sets off, seconds; 0 where it never does. */
export function setsOff({ frames }: Take): number {
  return frames.find(moves)?.time ?? 0;
}

/** The place of the last frame that is not after `time`; 0 before the first. */
export function frameAt(frames: readonly PoseFrame[], time: number): number {
  let low = 0;
  let high = frames.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if ((frames[middle] as PoseFrame).time <= time) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** The pose at `time`, held before the first and after the last frame. */
export function poseAt({ frames }: Take, time: number): ShownPose {
  const at = frameAt(frames, time);
  const before = frames[at] as PoseFrame;
  const after = frames[at + 1];
  if (!after || time <= before.time) return { ...before, starved: false };
  return between(before, after, time);
}

/** Whether the frames were planned: the flag of most of them. */
export function hasAssist({ frames }: Take): boolean {
  const planned = frames.filter(({ flags }) => (flags & POSE_FLAGS.assist) !== 0).length;
  return 2 * planned >= frames.length;
}

/** Whether two takes are of the same place, so that one can be laid over the other. */
export function samePlace(a: Take, b: Take): boolean {
  return a.scene === b.scene || JSON.stringify(a.scene) === JSON.stringify(b.scene);
}
