/** The clock of a replay: plays, pauses, steps, loops, at a speed of its own. */

import { STEP } from "./take";

export const SPEEDS = [0.25, 0.5, 1, 2, 4] as const;

export class Player {
  time = 0;
  playing = false;
  loop = false;
  speed = 1;

  /** @param duration seconds */
  constructor(readonly duration: number) {}

  /** Goes on by `dt` seconds of the page's time. */
  advance(dt: number): void {
    if (!this.playing) return;
    this.time += dt * this.speed;
    if (this.time < this.duration) return;
    if (this.loop && this.duration > 0) this.time %= this.duration;
    else {
      this.time = this.duration;
      this.playing = false;
    }
  }

  /** Plays or pauses; at the end it begins anew. */
  toggle(): void {
    if (!this.playing && this.time >= this.duration - 1e-9) this.time = 0;
    this.playing = !this.playing;
  }

  seek(time: number): void {
    this.time = Math.min(this.duration, Math.max(0, time));
  }

  /** So many steps of 1/60 s, back where negative; pauses. */
  step(steps: number): void {
    this.playing = false;
    this.seek(this.time + steps * STEP);
  }
}
