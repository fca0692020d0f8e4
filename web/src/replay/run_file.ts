/** Recordings that the server reads and poses: `.elbow` files that were dropped here, or the one it was started with. */

import { readPoseFrame, type PoseFrame, type Run } from "../generated/messages";
import { asked, sent } from "../net/asked";
import { runUrl, shownRunUrl } from "../net/endpoints";
import { NOTHING_LOOSE } from "../stage/loose";
import { text } from "../texts/texts";
import type { Take } from "./take";

/** A run, and what there is to say about it. */
export interface ReadRun {
  readonly take: Take;
  readonly run: Run;
}

/** Has the server read a recording. @throws Error with one sentence for the user */
export async function readRun(file: File): Promise<ReadRun> {
  return parseRun(await (await sent(runUrl(file.name), file)).arrayBuffer());
}

/** The recording that the server was started with. @throws Error */
export async function shownRun(): Promise<ReadRun> {
  return parseRun(await (await asked(shownRunUrl())).arrayBuffer());
}

let count = 0;

/** Reads the server's answer: the length of the head, the head as JSON, frames of one size. @throws Error */
export function parseRun(answer: ArrayBuffer): ReadRun {
  const length = new DataView(answer).getUint32(0, true);
  const run = JSON.parse(new TextDecoder().decode(new Uint8Array(answer, 4, length))) as Run;
  const frames: PoseFrame[] = [];
  for (let i = 0; i < run.frames; i++) {
    const at = 4 + length + i * run.frameBytes;
    const frame = readPoseFrame(answer.slice(at, at + run.frameBytes));
    if (frame) frames.push(frame);
  }
  if (frames.length === 0) throw new Error(text("replay.noFrames", run.name));
  const { scene, avatar, planner, name } = run;
  return { take: { id: -++count, scene, loose: NOTHING_LOOSE, avatar, planner, file: name, frames }, run };
}
