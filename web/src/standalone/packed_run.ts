/** Reads a run that is packed in its own page; the same layout as in elbowroom/server/standalone/packed_run.py. */

import type { AvatarMessage, PoseFrame, SceneMessage } from "../generated/messages";
import type { Take } from "../replay/take";
import { NOTHING_LOOSE } from "../stage/loose";

const UNIT = 32767;
const PER_METRE = 4000;

interface Head {
  readonly name: string;
  readonly planner: string;
  readonly scene: SceneMessage;
  readonly avatar: AvatarMessage;
  readonly frames: number;
  readonly joints: number;
  readonly capsules: number;
  readonly scalars: readonly string[];
  readonly avatarBytes: number;
}

/** A run, and the avatar's file if it is in it. */
export interface PackedRun {
  readonly take: Take;
  readonly avatar: Uint8Array<ArrayBuffer> | null;
}

const NO_FRAME: PoseFrame = {
  flags: 0, index: 0, time: 0, simTime: 0, acknowledged: 0, epoch: 0, avatarRevision: 0, phase: 0, queueFill: 0,
  jointCount: 0, capsuleCount: 0, x: 0, y: 0, z: 0, heading: 0, forward: 0, lateral: 0, turn: 0, gait: 0,
  clearance: Infinity, hipsX: 0, hipsY: 0, hipsZ: 0, rotations: new Float32Array(), capsules: new Float32Array(),
};

/** @param addressOf makes an address for the avatar's file */
export function readPackedRun(data: ArrayBuffer, addressOf: (file: Uint8Array<ArrayBuffer>) => string): PackedRun {
  const length = new DataView(data).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length))) as Head;
  const { frames: count, joints, capsules } = head;
  let at = 4 + length;
  const taken = (bytes: number): ArrayBuffer => data.slice(at, (at += bytes));
  const times = new Float32Array(taken(4 * count));
  const scalars = head.scalars.map((name) => [camel(name), new Float32Array(taken(4 * count))] as const);
  const rotations = columns(taken(2 * 4 * joints * count), count, UNIT);
  const segments = columns(taken(2 * 6 * capsules * count), count, PER_METRE);
  const avatar = head.avatarBytes > 0 ? new Uint8Array(taken(head.avatarBytes)) : null;
  const frames = Array.from(times, (time, i): PoseFrame => {
    const told = Object.fromEntries(scalars.map(([name, column]) => [name, column[i] ?? 0]));
    const frame = { ...NO_FRAME, ...told, index: i, time, jointCount: joints, capsuleCount: capsules };
    return { ...frame, rotations: unitary(rotations(i)), capsules: about(segments(i), frame) };
  });
  const message = { ...head.avatar, url: avatar && addressOf(avatar) };
  const { scene, planner, name } = head;
  return { take: { id: 0, scene, loose: NOTHING_LOOSE, avatar: message, planner, file: name, frames }, avatar };
}

/** Undoes the differences; gives the values of a frame. */
function columns(bytes: ArrayBuffer, count: number, unit: number): (frame: number) => Float32Array {
  const values = new Int16Array(bytes);
  for (let i = 0; i < values.length; i++) if (i % count !== 0) values[i] = (values[i] ?? 0) + (values[i - 1] ?? 0);
  const wide = count > 0 ? values.length / count : 0;
  return (frame) => Float32Array.from({ length: wide }, (_, column) => (values[column * count + frame] ?? 0) / unit);
}

/** Quaternions of length 1 again. */
function unitary(rotations: Float32Array): Float32Array {
  for (let i = 0; i < rotations.length; i += 4) {
    const length = Math.hypot(...rotations.subarray(i, i + 4)) || 1;
    for (let k = i; k < i + 4; k++) rotations[k] = (rotations[k] ?? 0) / length;
  }
  return rotations;
}

/** Ends of capsules in the world, where they were told about the root. */
function about(segments: Float32Array, { x, y, z }: PoseFrame): Float32Array {
  const root = [x, y, z];
  return segments.map((value, i) => value + (root[i % 3] ?? 0));
}

function camel(name: string): string {
  return name.replace(/_(.)/g, (_, letter: string) => letter.toUpperCase());
}
