/** Saves a run for other programs: the page sends its frames as they were shown, the server writes the file. */

import type { PoseFrame } from "../generated/messages";
import { motionUrl } from "../net/endpoints";
import { download } from "./film";
import type { Take } from "./take";

/** What a run can be saved as, by the endings of the files. */
export const SAVED_AS = ["bvh", "glb", "vrma", "x3d", "usda", "csv", "npz"] as const;
export type SavedAs = (typeof SAVED_AS)[number];

/** Numbers of a frame before its rotations, see `server/saved_motion.py`. */
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

/** Has a take written and hands the file over; what there is to say about it, or "". @throws Error with one sentence for the user */
export async function save(take: Take, ending: SavedAs): Promise<string> {
  const headers = { "Content-Type": "application/octet-stream" };
  const response = await fetch(motionUrl(take.avatar.id, ending), { method: "POST", headers, body: packed(take) });
  if (!response.ok) {
    const { error } = (await response.json().catch(() => ({}))) as { error?: string };
    throw new Error(error ?? `status ${response.status}`);
  }
  download(await response.blob(), `${take.scene.name.replace(/[^\w-]+/g, "-")}.${ending}`);
  return decodeURIComponent(response.headers.get("x-elbowroom-note") ?? "");
}
