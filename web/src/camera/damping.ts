/** Damping that does not depend on the frame rate. */

/** Moves `value` towards `target`; after `halflife` seconds half of the way is left. */
export function damp(value: number, target: number, halflife: number, dt: number): number {
  return target + (value - target) * 2 ** (-dt / Math.max(halflife, 1e-6));
}

/** The angle in (-pi, pi] that is equal to `angle` up to full turns. */
export function wrapAngle(angle: number): number {
  const wrapped = angle - 2 * Math.PI * Math.floor((angle + Math.PI) / (2 * Math.PI));
  return wrapped === -Math.PI ? Math.PI : wrapped;
}

/** `damp` for angles in radians: takes the short way round. */
export function dampAngle(angle: number, target: number, halflife: number, dt: number): number {
  return angle + damp(0, wrapAngle(target - angle), halflife, dt);
}
