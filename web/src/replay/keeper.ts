/** Keeps the walks of this page as they are shown, so that each can be played again: no server is needed for it. */

import type { AvatarMessage, PoseFrame, SceneMessage } from "../generated/messages";
import type { Loose } from "../stage/loose";
import { moves, type Take } from "./take";

/** Frames of all walks together: ten minutes; the oldest go first, and a walk of five minutes is told in two. */
export const MOST_FRAMES = 36_000;
const MOST_TAKES = 12;
/** A walk shorter than this is none, seconds. */
const SHORTEST = 1;
/** Seconds that are kept of the standing before a walk; while nothing moves frames come seldom. */
const LEAD = 0.25;

/** What is shown while frames come. */
export interface Circumstances {
  readonly scene: SceneMessage;
  readonly loose: Loose;
  readonly avatar: AvatarMessage;
  readonly planner: string;
}

interface Draft {
  readonly id: number;
  circumstances: Circumstances;
  /** `time` is the simulated one. */
  frames: PoseFrame[];
  moved: boolean;
}

export class WalkKeeper {
  private readonly done: Take[] = [];
  private draft: Draft | null = null;
  private count = 0;

  constructor(private readonly most = MOST_FRAMES) {}

  /** Notes a frame; null where what plays is no walk. Paused and repeated frames are left out. */
  add(frame: PoseFrame, circumstances: Circumstances | null): void {
    if (!circumstances || circumstances.avatar.revision !== frame.avatarRevision) {
      this.finish();
      return;
    }
    const last = this.draft?.frames.at(-1);
    const goesOn = last !== undefined && last.epoch === frame.epoch && last.avatarRevision === frame.avatarRevision &&
      last.jointCount === frame.jointCount && frame.simTime >= last.simTime;
    if (!this.draft || !goesOn) this.begin(circumstances);
    const { draft } = this;
    if (!draft || (goesOn && frame.simTime === last.simTime)) return;
    draft.circumstances = circumstances;
    draft.frames.push({ ...frame, time: frame.simTime });
    draft.moved ||= moves(frame);
    while (!draft.moved && frame.simTime - (draft.frames[1]?.time ?? frame.simTime) >= LEAD) draft.frames.shift();
    this.shorten(draft);
  }

  /** All walks, the oldest first; the last is the one that is still going on. */
  takes(): readonly Take[] {
    const current = this.draft && taken(this.draft);
    return current ? [...this.done, current] : [...this.done];
  }

  private begin(circumstances: Circumstances): void {
    this.finish();
    this.draft = { id: ++this.count, circumstances, frames: [], moved: false };
  }

  private finish(): void {
    const take = this.draft && taken(this.draft);
    this.draft = null;
    if (!take) return;
    this.done.push(take);
    if (this.done.length > MOST_TAKES) this.done.shift();
  }

  private shorten(draft: Draft): void {
    let kept = draft.frames.length + this.done.reduce((sum, { frames }) => sum + frames.length, 0);
    while (kept > this.most && this.done.length > 0) kept -= this.done.shift()?.frames.length ?? 0;
    if (draft.frames.length >= this.most / 2) this.begin(draft.circumstances);
  }
}

/** A draft as a take whose time begins at 0; null where too little happens in it. */
function taken({ id, circumstances, frames, moved }: Draft): Take | null {
  const [first, last] = [frames[0], frames.at(-1)];
  if (!moved || !first || !last || last.time - first.time < SHORTEST) return null;
  const begun = first.time;
  return { id, ...circumstances, file: "", frames: frames.map((frame) => ({ ...frame, time: frame.time - begun })) };
}
