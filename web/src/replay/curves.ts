/** What is drawn under the timeline: clearance, and how far trunk and arms are turned from how the take began. */

import type { PoseFrame } from "../generated/messages";
import { frameAt, type Take } from "./take";

/** The joints that are told, each with the bones whose turns add up to its own. */
export const JOINTS = {
  trunk: ["spine", "chest", "upperChest"],
  leftShoulder: ["leftShoulder", "leftUpperArm"],
  leftElbow: ["leftLowerArm"],
  rightShoulder: ["rightShoulder", "rightUpperArm"],
  rightElbow: ["rightLowerArm"],
} as const;

export type JointName = keyof typeof JOINTS;
export const JOINT_NAMES = Object.keys(JOINTS) as JointName[];

/** Values at evenly spaced moments from the beginning of a take to its end. */
export interface Curves {
  /** Metres; the least between two moments, infinite where nothing is near. */
  readonly clearance: Float32Array;
  /** Degrees from the first frame. */
  readonly joints: Readonly<Record<JointName, Float32Array>>;
}

type Quaternion = readonly [number, number, number, number];

/** The curves at `count` moments over `seconds`. */
export function curvesOf(take: Take, seconds: number, count: number): Curves {
  const { frames } = take;
  const at = Array.from({ length: count + 1 }, (_, i) => frameAt(frames, (seconds * i) / count));
  const clearance = Float32Array.from({ length: count }, (_, i) => leastClearance(frames, at[i] ?? 0, at[i + 1] ?? 0));
  const joints = Object.fromEntries(JOINT_NAMES.map((name) => [name, angles(take, name, at.slice(0, count))]));
  return { clearance, joints: joints as Record<JointName, Float32Array> };
}

function leastClearance(frames: readonly PoseFrame[], first: number, last: number): number {
  let least = Infinity;
  for (let i = first; i <= last; i++) least = Math.min(least, frames[i]?.clearance ?? Infinity);
  return least;
}

function angles({ avatar, frames }: Take, name: JointName, at: readonly number[]): Float32Array {
  const bones = JOINTS[name].map((bone) => avatar.bones.findIndex((one) => one.name === bone)).filter((i) => i >= 0);
  const turn = (frame: PoseFrame | undefined) => bones.reduce<Quaternion>((sum, i) => product(sum, rotation(frame, i)), [0, 0, 0, 1]);
  const rest = turn(frames[0]);
  return Float32Array.from(at, (i) => degreesBetween(rest, turn(frames[i])));
}

function rotation(frame: PoseFrame | undefined, joint: number): Quaternion {
  const r = frame?.rotations;
  const k = 4 * joint;
  return [r?.[k] ?? 0, r?.[k + 1] ?? 0, r?.[k + 2] ?? 0, r?.[k + 3] ?? 1];
}

function product([ax, ay, az, aw]: Quaternion, [bx, by, bz, bw]: Quaternion): Quaternion {
  return [
    aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
    aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz,
  ];
}

/** The angle of the turn from one to the other. */
export function degreesBetween(a: Quaternion, b: Quaternion): number {
  const dot = Math.abs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]);
  return (360 / Math.PI) * Math.acos(Math.min(1, dot));
}
