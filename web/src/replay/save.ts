/** Saves a run for other programs: the page sends its frames as they were shown, the server writes the file. */

import type { PoseFrame } from "../generated/messages";
import { sent } from "../net/asked";
import { motionUrl, pageUrl } from "../net/endpoints";
import { inOwnWords } from "../texts/worded";
import { download } from "./film";
import type { Take } from "./take";

/** What a run can be saved as, by the endings of the files. */
export const SAVED_AS = ["html", "bvh", "glb", "vrma", "x3d", "usda", "csv", "npz"] as const;
export type SavedAs = (typeof SAVED_AS)[number];

/** Bytes of a pose frame before its time. */
const TIME_AT = 8;

/** Numbers of a frame before its rotations, see `server/stores/saved_motion.py`. */
const HEAD = 9;

/** The frames of a take as the server reads them. */
export function packed({ frames }: Take): Float32Array<ArrayBuffer> {
  const size = HEAD + 4 * (frames[0]?.jointCount ?? 0);
  const numbers = new Float32Array(size * frames.length);
  frames.forEach((frame: PoseFrame, i) => {
    const { time, epoch, x, y, z, heading, hipsX, hipsY, hipsZ, rotations } = frame;
    numbers.set([time, epoch, x, y, z, heading, hipsX, hipsY, hipsZ], size * i);
    numbers.set(rotations.subarray(0, size - HEAD), size * i + HEAD);
  });
  return numbers;
}

/** A take as the server reads a whole run: the length of its head, the head, pose frames as they came. */
export function wholeRun({ scene, loose, avatar, planner, file, frames }: Take): Blob {
  const standing = scene.obstacles.filter((_, i) => !loose.has(i));
  const shown = { ...scene, obstacles: standing, moving: [...scene.moving, ...loose.values()] };
  const head = new TextEncoder().encode(JSON.stringify({ name: file || scene.title, planner, note: "", scene: shown, avatar }));
  const size = new DataView(new ArrayBuffer(4));
  size.setUint32(0, head.length, true);
  return new Blob([size.buffer, head, ...frames.map(asSent)]);
}

/** A frame as it came over the wire, but for its time. */
function asSent({ rotations, time }: PoseFrame): ArrayBuffer {
  const message = (rotations.buffer as ArrayBuffer).slice(0);
  new DataView(message).setFloat64(TIME_AT, time, true);
  return message;
}

/** Has a take written and hands the file over; what there is to say about it, or "". @throws Error with one sentence for the user */
export async function save(take: Take, ending: SavedAs): Promise<string> {
  const response = ending === "html"
    ? await sent(pageUrl(take.avatar.id), wholeRun(take))
    : await sent(motionUrl(take.avatar.id, ending), packed(take));
  download(await response.blob(), `${take.scene.name.replace(/[^\w-]+/g, "-")}.${ending}`);
  return inOwnWords(decodeURIComponent(response.headers.get("x-elbowroom-note") ?? ""));
}
