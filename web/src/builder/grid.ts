/** The lines behind the plan: finer ones the nearer one looks, and the edge of the ground. */

import type { Side } from "./outline";
import type { Plan, Vec2 } from "./plan";

const STEPS = [0.1, 0.5, 1, 5, 10, 50, 100];
const MOST_LINES = 40;

/** SVG of the lines over a part of the board: its middle and its size. */
export function gridLines([u, v]: Vec2, [width, height]: Vec2, ground: Plan["ground"], side: Side): string {
  const step = STEPS.find((one) => Math.max(width, height) / one <= MOST_LINES) ?? 100;
  const marks = (middle: number, size: number) => {
    const first = Math.ceil((middle - size / 2) / step);
    return Array.from({ length: Math.floor((middle + size / 2) / step) - first + 1 }, (_, i) => (first + i) * step);
  };
  const [left, top] = [u - width / 2, v - height / 2];
  const upright = marks(u, width).map((at) => line(`M${at} ${top}v${height}`, at, step));
  const level = marks(v, height).map((at) => line(`M${left} ${at}h${width}`, at, step));
  return edge(ground, side, [left, width]) + upright.join("") + level.join("");
}

function line(path: string, at: number, step: number): string {
  const whole = Math.abs(at - Math.round(at / (step * 5)) * step * 5) < step / 10;
  return `<path class="${whole ? "line whole" : "line"}" d="${path}"/>`;
}

function edge({ center: [x, z], size: [wide, deep] }: Plan["ground"], side: Side, [left, width]: Vec2): string {
  if (side === "side") return `<path class="floor" d="M${left} 0h${width}"/>`;
  return `<rect class="ground" x="${-x - wide / 2}" y="${-z - deep / 2}" width="${wide}" height="${deep}"/>`;
}
