/** One sentence about what is going on; screen readers hear it. */

import { POSE_FLAGS, type Crossed, type PoseFrame, type Settings, type Status } from "../generated/messages";
import { blockedSentence } from "./blocked_sentence";
import { byId } from "./dom";

type Tone = "" | "good" | "bad";

const CELEBRATION = 6;
const QUIET_BEFORE_CHANGE = 0.25;

export class StatusLine {
  private readonly element = byId("status", HTMLElement);
  private celebrated: { readonly crossed: Crossed; readonly until: number } | null = null;
  private everMoved = false;
  private wantedSince = 0;
  private wanted = "";

  crossed(crossed: Crossed, now: number): void {
    this.celebrated = { crossed, until: now + CELEBRATION };
  }

  /** The next sentence is said at once: a new scene, a reset. */
  restart(): void {
    this.celebrated = null;
  }

  moved(): void {
    this.everMoved = true;
  }

  update(pose: PoseFrame | null, status: Status | null, settings: Settings | null, now: number): void {
    const [text, tone] = this.sentence(pose, status, settings, now);
    if (text !== this.wanted) {
      this.wanted = text;
      this.wantedSince = now;
    }
    if (now - this.wantedSince < QUIET_BEFORE_CHANGE || this.element.textContent === text) return;
    this.element.textContent = text;
    this.element.dataset["tone"] = tone;
  }

  private sentence(
    pose: PoseFrame | null, status: Status | null, settings: Settings | null, now: number,
  ): readonly [string, Tone] {
    if (!pose || !settings) return ["", ""];
    if (this.celebrated && now < this.celebrated.until) return [crossedText(this.celebrated.crossed), "good"];
    if (settings.paused) return ["Paused: . for one step, P to go on", ""];
    if (settings.clip !== "") return ["A recorded motion plays: choose “none: walk” in the menu to steer", ""];
    if (!settings.assist && (pose.flags & POSE_FLAGS.touching) !== 0) return ["Assist is off: the body passes through things", "bad"];
    if (status?.blocked && settings.assist) return [blockedSentence(status.blocked), "bad"];
    if ((pose.flags & POSE_FLAGS.stuck) !== 0) return ["No room this way: back up with S and try another", "bad"];
    if (!this.everMoved) return [firstHint(), ""];
    if (status?.rootKind === "stopped") return ["The way ahead is closed", ""];
    if (status?.rootKind === "detour") return ["Going round", ""];
    return ["", ""];
  }
}

function crossedText({ seconds, stuckTimes }: Crossed): string {
  const stuck = stuckTimes === 0 ? "never stuck" : stuckTimes === 1 ? "stuck once" : `stuck ${stuckTimes} times`;
  return `Through in ${seconds.toFixed(1)} s, ${stuck}`;
}

function firstHint(): string {
  return window.matchMedia("(pointer: coarse)").matches
    ? "Drag on the left to walk through the gate"
    : "Hold W to walk through the gate · ? for help";
}
