/** Draws the curves and marks of a take; what does not change from frame to frame is drawn once. */

import { JOINT_NAMES, type Curves, type JointName } from "./curves";
import { MARK_KINDS, type Mark, type MarkKind } from "./marks";

/** What is drawn. */
export interface ChartData {
  readonly curves: Curves;
  readonly marks: readonly Mark[];
  /** Of the run that it is compared with. */
  readonly other: Curves | null;
  readonly seconds: number;
  /** Titles of the two lanes. */
  readonly titles: readonly [string, string];
}

/** Blue, orange and their darker kin tell left from right and shoulder from elbow, for colour-blind eyes too. */
export const JOINT_COLORS: Readonly<Record<JointName, string>> = {
  trunk: "#8a7f6e", leftShoulder: "#2f7fb0", leftElbow: "#7fb9dc", rightShoulder: "#c2641f", rightElbow: "#e8a860",
};
export const MARK_COLORS: Readonly<Record<MarkKind, string>> = {
  plan: "#8a94a3", contact: "#c5372c", stuck: "#c98a12", crossed: "#17856f",
};

/** Clearance above this is drawn at the top, metres; angles above this too, degrees. */
const MOST_CLEARANCE = 0.3;
const LEAST_ANGLE = 40;
const MARKS_HEIGHT = 12;
const GAP = 8;

export function drawChart(canvas: HTMLCanvasElement, data: ChartData): void {
  const width = canvas.clientWidth;
  const height = canvas.clientHeight;
  const context = canvas.getContext("2d");
  if (!context || width === 0) return;
  canvas.width = Math.round(width * devicePixelRatio);
  canvas.height = Math.round(height * devicePixelRatio);
  context.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
  const style = getComputedStyle(canvas);
  const lane = (height - MARKS_HEIGHT - GAP) / 2;
  const upper = { top: MARKS_HEIGHT, height: lane, width };
  const lower = { top: MARKS_HEIGHT + lane + GAP, height: lane, width };
  drawMarks(context, data, { top: 0, height, width });
  drawClearance(context, data, upper, style);
  drawJoints(context, data, lower);
  context.fillStyle = style.getPropertyValue("--ink-soft");
  context.font = `600 10.5px ${style.fontFamily}`;
  data.titles.forEach((title, i) => context.fillText(title, 2, (i === 0 ? upper : lower).top + 11));
}

interface Lane {
  readonly top: number;
  readonly height: number;
  readonly width: number;
}

function drawMarks(context: CanvasRenderingContext2D, { marks, seconds }: ChartData, lane: Lane): void {
  const x = (time: number) => (time / Math.max(seconds, 1e-6)) * lane.width;
  for (const kind of MARK_KINDS) {
    context.fillStyle = MARK_COLORS[kind];
    for (const mark of marks) {
      if (mark.kind !== kind) continue;
      const left = x(mark.time);
      if (kind === "plan") context.fillRect(left - 0.5, 3, 1, 6);
      else {
        const wide = Math.max(3, x(mark.until) - left);
        context.fillRect(left - 1.5, 0, wide, MARKS_HEIGHT - 2);
        context.globalAlpha = 0.14;
        context.fillRect(left - 1.5, MARKS_HEIGHT, wide, lane.height - MARKS_HEIGHT);
        context.globalAlpha = 1;
      }
    }
  }
}

function drawClearance(context: CanvasRenderingContext2D, { curves, other }: ChartData, lane: Lane, style: CSSStyleDeclaration): void {
  const accent = style.getPropertyValue("--accent");
  const y = (metres: number) => lane.top + lane.height * (1 - Math.min(1, Math.max(0, metres / MOST_CLEARANCE)));
  context.fillStyle = style.getPropertyValue("--control");
  context.fillRect(0, lane.top, lane.width, lane.height);
  if (other) {
    context.strokeStyle = style.getPropertyValue("--ink-soft");
    context.setLineDash([3, 3]);
    path(context, other.clearance, lane.width, y);
    context.stroke();
    context.setLineDash([]);
  }
  path(context, curves.clearance, lane.width, y);
  context.strokeStyle = accent;
  context.lineWidth = 1.5;
  context.stroke();
  context.lineTo(lane.width, lane.top + lane.height);
  context.lineTo(0, lane.top + lane.height);
  context.closePath();
  context.globalAlpha = 0.16;
  context.fillStyle = accent;
  context.fill();
  context.globalAlpha = 1;
  context.lineWidth = 1;
}

function drawJoints(context: CanvasRenderingContext2D, { curves }: ChartData, lane: Lane): void {
  const most = Math.max(LEAST_ANGLE, ...JOINT_NAMES.map((name) => curves.joints[name].reduce((a, b) => Math.max(a, b), 0)));
  const y = (degrees: number) => lane.top + lane.height * (1 - (0.96 * degrees) / most);
  for (const name of JOINT_NAMES) {
    context.strokeStyle = JOINT_COLORS[name];
    context.lineWidth = 1.3;
    path(context, curves.joints[name], lane.width, y);
    context.stroke();
  }
}

function path(context: CanvasRenderingContext2D, values: Float32Array, width: number, y: (value: number) => number): void {
  context.beginPath();
  values.forEach((value, i) => context.lineTo(((i + 0.5) / values.length) * width, y(value)));
}
