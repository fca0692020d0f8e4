/** What happened when in a take: plans, contacts, times stuck, the finish. */

import { POSE_FLAGS, POSE_PHASES, type PoseFrame } from "../generated/messages";
import type { Take } from "./take";

export type MarkKind = "plan" | "contact" | "stuck" | "crossed";

/** From `time` to `until`, seconds; a moment where both are the same. */
export interface Mark {
  readonly kind: MarkKind;
  readonly time: number;
  readonly until: number;
}

const PLAY = POSE_PHASES.indexOf("play");

const HOLDS: Readonly<Record<MarkKind, (frame: PoseFrame) => boolean>> = {
  plan: ({ phase }) => phase !== PLAY,
  contact: ({ flags }) => (flags & POSE_FLAGS.touching) !== 0,
  stuck: ({ flags }) => (flags & POSE_FLAGS.stuck) !== 0,
  crossed: ({ flags }) => (flags & POSE_FLAGS.finished) !== 0,
};

export const MARK_KINDS = Object.keys(HOLDS) as MarkKind[];
/** Those that last; the others are told at the moment when they begin. */
const LASTS: ReadonlySet<MarkKind> = new Set(["contact", "stuck"]);

/** All marks in order of time. */
export function marksOf({ frames }: Take): readonly Mark[] {
  const marks = MARK_KINDS.flatMap((kind) => spans(frames, HOLDS[kind]).map(([time, until]) => (
    { kind, time, until: LASTS.has(kind) ? until : time }
  )));
  return marks.sort((a, b) => a.time - b.time);
}

/** First and last time of each run of frames for which something holds. */
function spans(frames: readonly PoseFrame[], holds: (frame: PoseFrame) => boolean): [number, number][] {
  const found: [number, number][] = [];
  let running = false;
  for (const frame of frames) {
    const now = holds(frame);
    const last = found.at(-1);
    if (now && running && last) last[1] = frame.time;
    else if (now) found.push([frame.time, frame.time]);
    running = now;
  }
  return found;
}
