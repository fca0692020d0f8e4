/** Eyelids that close for a moment every few seconds. */

import type { VRMExpressionManager } from "@pixiv/three-vrm";

const CLOSING = 0.16;
const SHORTEST = 2.2;
const SPREAD = 3.6;

export class Blinking {
  private wait = 2;
  private progress = Infinity;

  constructor(private readonly expressions: VRMExpressionManager) {}

  update(dt: number): void {
    this.wait -= dt;
    if (this.wait <= 0) {
      this.wait = SHORTEST + SPREAD * Math.random();
      this.progress = 0;
    }
    if (this.progress > 1) return;
    this.progress += dt / CLOSING;
    this.expressions.setValue("blink", Math.sin(Math.PI * Math.min(1, this.progress)));
  }
}
