/** One frame after another: reads the controls, takes the pose of this moment, draws it. */

import { FrameStats } from "../frame_stats";
import { POSE_FLAGS } from "../generated/messages";
import type { Controls } from "../input/controls";
import { NO_INTENT } from "../input/steering";
import type { ShownPose } from "../net/pose_timeline";
import type { Session } from "../net/session";
import { OVERLAYS } from "../overlays/overlay_names";
import type { Picture } from "../picture";
import type { Pushing } from "../pushing/pushing";
import type { Steps } from "../steps/steps";
import type { StatusLine } from "../ui/status_line";
import type { Modes } from "./modes";
import type { Taste } from "./taste";

const LONGEST_FRAME = 0.1;

export interface FramesParts {
  readonly session: Session;
  readonly picture: Picture;
  readonly controls: Controls;
  readonly steps: Steps;
  readonly modes: Modes;
  readonly pushing: Pushing;
  readonly taste: Taste;
  readonly statusLine: StatusLine;
}

export class Frames {
  readonly stats = new FrameStats();
  /** The pose that is shown; null before the first. */
  pose: ShownPose | null = null;
  drawn = 0;
  private last = performance.now() / 1000;

  constructor(private readonly parts: FramesParts) {}

  begin(): void {
    requestAnimationFrame(() => this.frame());
  }

  private frame(): void {
    requestAnimationFrame(() => this.frame());
    const { session, picture, controls, modes, pushing, steps, taste } = this.parts;
    const now = performance.now() / 1000;
    const elapsed = now - this.last;
    this.last = now;
    this.stats.add(elapsed);
    picture.measure(elapsed);
    const dt = Math.min(elapsed, LONGEST_FRAME);
    controls.update(dt);
    pushing.update(dt);
    const replayed = modes.replay.advance(dt);
    this.pose = replayed ?? session.poseAt(now) ?? this.pose;
    const { sound, overlays } = taste.preferences;
    if (replayed) this.drawReplayed(replayed, dt);
    else this.drawLive(now, dt);
    if (this.pose) steps.update(this.pose, { heard: sound, shown: overlays.has("footprints") });
    this.drawn++;
  }

  private drawLive(now: number, dt: number): void {
    const { session, picture, controls, taste, statusLine } = this.parts;
    const { settings, status } = session;
    const { intent } = controls;
    if (intent.forward !== 0 || intent.right !== 0 || intent.strafe !== 0) statusLine.moved();
    statusLine.update(this.pose, status, settings, now);
    picture.draw(this.pose, {
      status, intent, steering: taste.steering, shown: taste.preferences.overlays,
      inset: taste.insetShown, markTouching: settings?.assist === false,
    }, dt);
  }

  private drawReplayed(pose: ShownPose, dt: number): void {
    const { picture, taste } = this.parts;
    const shown = new Set(OVERLAYS.filter((name) => name === "capsules" && taste.preferences.overlays.has(name)));
    picture.draw(pose, {
      status: null, intent: NO_INTENT, steering: "tank", shown,
      inset: taste.insetShown, markTouching: (pose.flags & POSE_FLAGS.assist) === 0,
    }, dt);
  }
}
