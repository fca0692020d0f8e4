/** Soft dark footprints where boxes stand on or near the ground, drawn once per scene. */

import type { PreparedBox } from "../camera/spring_arm";

const FADE_HEIGHT = 1.6;
const STRENGTH = 0.6;

/**
 * A canvas of `width` by `depth` metres round `center`: white where the ground is open, darker near the boxes.
 *
 * @param scale pixels per metre
 * @param color of the darkest shadow
 */
export function drawContactShadows(
  boxes: readonly PreparedBox[], center: readonly [number, number], width: number, depth: number, scale: number,
  color: string,
): HTMLCanvasElement {
  const canvas = document.createElement("canvas");
  canvas.width = Math.max(1, Math.round(width * scale));
  canvas.height = Math.max(1, Math.round(depth * scale));
  const pen = canvas.getContext("2d");
  if (!pen) return canvas;
  pen.fillStyle = "#fff";
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.setTransform(scale, 0, 0, scale, canvas.width / 2 - center[0] * scale, canvas.height / 2 - center[1] * scale);
  for (const box of boxes) {
    const height = Math.max(0, lowestPoint(box));
    const strength = STRENGTH * Math.max(0, 1 - height / FADE_HEIGHT);
    if (strength === 0) continue;
    const outline = footprint(box);
    for (const [blur, share] of [[0.05 + height * 0.3, 0.55], [0.2 + height * 0.5, 0.45]] as const) {
      pen.filter = `blur(${(blur * scale).toFixed(1)}px)`;
      pen.globalAlpha = strength * share;
      pen.fillStyle = color;
      pen.beginPath();
      outline.forEach(([x, z], i) => (i === 0 ? pen.moveTo(x, z) : pen.lineTo(x, z)));
      pen.closePath();
      pen.fill();
    }
  }
  return canvas;
}

function corners(box: PreparedBox): [number, number, number][] {
  const m = box.toBox;
  const points: [number, number, number][] = [];
  for (const sx of [-1, 1]) {
    for (const sy of [-1, 1]) {
      for (const sz of [-1, 1]) {
        const x = sx * box.halfSize[0];
        const y = sy * box.halfSize[1];
        const z = sz * box.halfSize[2];
        points.push([
          box.center[0] + m[0] * x + m[3] * y + m[6] * z,
          box.center[1] + m[1] * x + m[4] * y + m[7] * z,
          box.center[2] + m[2] * x + m[5] * y + m[8] * z,
        ]);
      }
    }
  }
  return points;
}

function lowestPoint(box: PreparedBox): number {
  return Math.min(...corners(box).map((p) => p[1]));
}

/** The convex outline of the box seen from above (monotone chain). */
export function footprint(box: PreparedBox): [number, number][] {
  const points = corners(box)
    .map(([x, , z]): [number, number] => [x, z])
    .sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const half = (sequence: [number, number][]) => {
    const chain: [number, number][] = [];
    for (const p of sequence) {
      while (chain.length >= 2) {
        const a = chain[chain.length - 2] as [number, number];
        const b = chain[chain.length - 1] as [number, number];
        if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 1e-12) break;
        chain.pop();
      }
      chain.push(p);
    }
    return chain.slice(0, -1);
  };
  return [...half(points), ...half([...points].reverse())];
}
