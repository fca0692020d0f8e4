/** Rotations as build mode needs them: quaternions x, y, z, w, and the three angles that people type. */

import { Euler, Quaternion } from "three";
import type { Turn, Vec3 } from "./plan";

/** A rotation about Y, radians. */
export function aboutY(angle: number): Turn {
  return [0, Math.sin(angle / 2), 0, Math.cos(angle / 2)];
}

/** `first`, then `second`. */
export function after(first: Turn, second: Turn): Turn {
  return quaternion(second).multiply(quaternion(first)).normalize().toArray();
}

/** Angles about X, Y and Z, radians; the rotation is Ry Rx Rz, as in scene files. */
export function anglesOf(turn: Turn): Vec3 {
  const { x, y, z } = new Euler().setFromQuaternion(quaternion(turn), "YXZ");
  return [x, y, z];
}

/** The rotation of such angles. */
export function turnOf([x, y, z]: Vec3): Turn {
  return new Quaternion().setFromEuler(new Euler(x, y, z, "YXZ")).normalize().toArray();
}

/** A point turned. */
export function turned([x, y, z]: Vec3, [a, b, c, w]: Turn): Vec3 {
  const u = 2 * (b * z - c * y), v = 2 * (c * x - a * z), t = 2 * (a * y - b * x);
  return [x + w * u + b * t - c * v, y + w * v + c * u - a * t, z + w * t + a * v - b * u];
}

/** An angle within half a turn to either side, radians. */
export function wrapped(angle: number): number {
  return angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));
}

function quaternion(turn: Turn): Quaternion {
  return new Quaternion(...turn);
}
