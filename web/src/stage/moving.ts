/** Where obstacles on tracks are at a time; the same rule as in elbowroom/world/obstacles/tracks/moving.py. */

import type { OrientedBox } from "../camera/spring_arm";
import type { MovingObstacle } from "../generated/messages";

/** The box round it as it stands at the scene's `time`, seconds. */
export function boxAt(box: MovingObstacle, time: number): OrientedBox {
  const { times, centers, yaws, form: { size } } = box;
  const at = within(box, time);
  let k = 0;
  while (k < times.length - 2 && (times[k + 1] ?? 0) <= at) k++;
  const begin = times[k] ?? 0;
  const share = Math.min(1, Math.max(0, (at - begin) / ((times[k + 1] ?? begin) - begin || 1)));
  const [ax, ay, az] = centers[k] ?? [0, 0, 0];
  const [bx, by, bz] = centers[k + 1] ?? [ax, ay, az];
  const yaw = mix(yaws[k] ?? 0, yaws[k + 1] ?? yaws[k] ?? 0, share);
  return {
    center: [mix(ax, bx, share), mix(ay, by, share), mix(az, bz, share)],
    rotation: [0, Math.sin(yaw / 2), 0, Math.cos(yaw / 2)],
    halfSize: [size[0] / 2, size[1] / 2, size[2] / 2],
  };
}

/** The time between the first key pose and the last that `time` stands for. */
function within({ times, repeat }: MovingObstacle, time: number): number {
  const span = times[times.length - 1] ?? 0;
  if (span === 0 || repeat === "once") return Math.min(Math.max(time, times[0] ?? 0), span);
  if (repeat === "loop") return remainder(time, span);
  return span - Math.abs(remainder(time, 2 * span) - span);
}

function remainder(value: number, span: number): number {
  return value - span * Math.floor(value / span);
}

function mix(a: number, b: number, share: number): number {
  return a + (b - a) * share;
}
