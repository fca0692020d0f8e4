/** Where a camera that has no room behind the avatar should rather look from: a little higher, lower or aside. */

import type { Vec3 } from "./vectors";

/** A change of the camera's direction, radians. */
export interface ViewShift {
  readonly yaw: number;
  readonly pitch: number;
}

export const NO_SHIFT: ViewShift = { yaw: 0, pitch: 0 };

const YAWS = [0, -0.3, 0.3, -0.6, 0.6] as const;
/** For a view that nobody steers by: between two walls it comes round until it looks along them. */
const WIDE_YAWS = [...YAWS, -0.9, 0.9, -1.15, 1.15, -1.35, 1.35] as const;
/** Nearer than so many metres one sees no more than a part of the body. */
const CRAMPED = 1.5;
const PITCHES = [0, -0.18, 0.2, -0.36, 0.4, 0.6, 0.8] as const;
/** With this share of the wanted distance the view is good enough to stay as the user chose it. */
const ENOUGH = 0.6;
/** Metres of distance that a radian of change must bring. */
const PRICE = 1.5;
/** Metres in favour of the shift in force, so that the camera does not waver. */
const LOYALTY = 0.3;

/** The unit vector from the pivot to a camera that looks along `heading` and down by `pitch`. */
export function backwards(heading: number, pitch: number): Vec3 {
  const flat = Math.cos(pitch);
  return [-Math.sin(heading) * flat, Math.sin(pitch), -Math.cos(heading) * flat];
}

/** How far a view may be shifted. */
export interface Leeway {
  /** Least and greatest pitch. */
  readonly pitch: readonly [low: number, high: number];
  /** Whether it may come round far. */
  readonly wide: boolean;
}

/** How far from the pivot the camera may be under a shift, metres. */
export type Reach = (shift: ViewShift) => number;

/** The shift that gains most distance for the least change; none where there is room enough. */
export function roomierView(
  reachUnder: Reach, pitch: number, wanted: number, current: ViewShift, { pitch: limits, wide }: Leeway,
): ViewShift {
  const enough = ENOUGH * wanted;
  if (reachUnder(NO_SHIFT) >= enough) return NO_SHIFT;
  let best = NO_SHIFT;
  let bestScore = -Infinity;
  for (const rise of PITCHES) {
    if (pitch + rise < limits[0] || pitch + rise > limits[1]) continue;
    for (const yaw of wide ? WIDE_YAWS : YAWS) {
      const reach = reachUnder({ yaw, pitch: rise });
      const loyal = yaw === current.yaw && rise === current.pitch ? LOYALTY : 0;
      const narrow = wide ? Math.max(0, CRAMPED - reach) : 0;
      const score = Math.min(reach, enough) + loyal - narrow - PRICE * Math.hypot(yaw, rise);
      if (score <= bestScore) continue;
      bestScore = score;
      best = { yaw, pitch: rise };
    }
  }
  return best;
}
