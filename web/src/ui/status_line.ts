/** One sentence about what is going on; screen readers hear it. */

import { POSE_FLAGS, type Crossed, type PoseFrame, type Settings, type Status } from "../generated/messages";
import { blockedSentence } from "./blocked_sentence";
import { worded } from "../texts/worded";
import { stuckWords } from "../texts/stuck_words";
import { text } from "../texts/texts";
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
    const [said, tone] = this.sentence(pose, status, settings, now);
    if (said !== this.wanted) {
      this.wanted = said;
      this.wantedSince = now;
    }
    if (now - this.wantedSince < QUIET_BEFORE_CHANGE || this.element.textContent === said) return;
    this.element.textContent = said;
    this.element.dataset["tone"] = tone;
  }

  private sentence(
    pose: PoseFrame | null, status: Status | null, settings: Settings | null, now: number,
  ): readonly [string, Tone] {
    if (!pose || !settings) return ["", ""];
    if (this.celebrated && now < this.celebrated.until) return [crossedText(this.celebrated.crossed), "good"];
    if (settings.paused) return [worded("Paused: . for one step, P to go on"), ""];
    if (settings.clip !== "") return [worded("A recorded motion plays: choose “none: walk” in the menu to steer"), ""];
    if (!settings.assist && (pose.flags & POSE_FLAGS.touching) !== 0) return [worded("Assist is off: the body passes through things"), "bad"];
    if (status?.blocked && settings.assist) return [blockedSentence(status.blocked), "bad"];
    if ((pose.flags & POSE_FLAGS.stuck) !== 0) return [worded("No room this way: back up with S and try another"), "bad"];
    if (!this.everMoved) return [firstHint(), ""];
    if (status?.rootKind === "stopped") return [worded("The way ahead is closed"), ""];
    if (status?.rootKind === "detour") return [worded("Going round"), ""];
    return ["", ""];
  }
}

function crossedText({ seconds, stuckTimes }: Crossed): string {
  return text("status.through", seconds.toFixed(1), stuckWords(stuckTimes));
}

function firstHint(): string {
  return window.matchMedia("(pointer: coarse)").matches
    ? worded("Drag on the left to walk through the gate")
    : worded("Hold W to walk through the gate · ? for help");
}
