/** How much to draw: fixed levels, and an automatic one that gives up resolution, then shadows, then smooth edges. */

export type QualityName = "low" | "medium" | "high" | "auto";

/** What the stage must do; the pixel ratio is relative to CSS pixels. */
export interface Quality {
  readonly pixelRatio: number;
  readonly shadows: boolean;
  readonly antialias: boolean;
  /** Physically based materials with the reflections of a soft room; without, the cheapest that still look right. */
  readonly rich: boolean;
}

const SOFTWARE = /swiftshader|llvmpipe|software|basic render/i;
const SLOW_FRAME = 0.024;
const FRAMES_PER_VERDICT = 75;
const RATIO_STEPS = [2, 1.5, 1, 0.75, 0.5] as const;

/** The levels by name, for a screen of `devicePixelRatio`. */
export function fixedQuality(name: "low" | "medium" | "high", devicePixelRatio: number): Quality {
  switch (name) {
    case "low":
      return { pixelRatio: 0.5, shadows: false, antialias: false, rich: false };
    case "medium":
      return { pixelRatio: Math.min(devicePixelRatio, 1), shadows: true, antialias: true, rich: true };
    case "high":
      return { pixelRatio: Math.min(devicePixelRatio, 2), shadows: true, antialias: true, rich: true };
  }
}

/** The level that `auto` begins with: software renderers start at the bottom instead of stuttering down to it. */
export function startingQuality(rendererName: string, devicePixelRatio: number): Quality {
  return fixedQuality(SOFTWARE.test(rendererName) ? "low" : "high", devicePixelRatio);
}

/** The next cheaper level, or null at the bottom. */
export function cheaper(quality: Quality): Quality | null {
  const ratio = RATIO_STEPS.find((step) => step < quality.pixelRatio - 1e-3);
  if (ratio !== undefined && ratio >= 0.75) return { ...quality, pixelRatio: ratio };
  if (quality.shadows) return { ...quality, shadows: false };
  if (quality.antialias) return { ...quality, antialias: false, rich: false };
  return ratio === undefined ? null : { ...quality, pixelRatio: ratio };
}

/** Watches frame times and says when to go one level down. */
export class QualityGovernor {
  private readonly times: number[] = [];

  /** Notes a frame's time in seconds; true when the level should drop. */
  frame(seconds: number): boolean {
    if (seconds > 0.5) return false;
    this.times.push(seconds);
    if (this.times.length < FRAMES_PER_VERDICT) return false;
    const median = [...this.times].sort((a, b) => a - b)[FRAMES_PER_VERDICT >> 1] ?? 0;
    this.times.length = 0;
    return median > SLOW_FRAME;
  }
}
