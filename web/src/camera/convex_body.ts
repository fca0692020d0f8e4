/** The nearest points of the shapes that are no boxes, each about its own origin; capsules and cylinders are about Y. */

import type { Form } from "../generated/messages";
import type { Vec3 } from "./vectors";

/** A convex body in its own axes. */
export interface ConvexBody {
  /** The point of the body, surface or inside, that is nearest to a point. */
  nearest(point: Vec3): Vec3;
}

/** The body of a form; none for what is taken to be all that is in its box. */
export function convexBody(form: Form): ConvexBody | undefined {
  const radius = form.size[0] / 2, half = form.size[1] / 2;
  switch (form.shape) {
    case "box":
    case "mesh": // told by its triangles
      return undefined;
    case "sphere":
      return roundLine(radius, 0);
    case "capsule":
      return roundLine(radius, half - radius);
    case "cylinder":
      return cylinder(radius, half);
    case "hull":
      return hull(form.corners, form.triangles);
  }
}

/** All that is within a radius of a line along Y. */
function roundLine(radius: number, half: number): ConvexBody {
  return {
    nearest([x, y, z]) {
      const middle = clamp(y, half), away = Math.hypot(x, y - middle, z);
      const share = away > radius ? radius / away : 1;
      return [x * share, middle + (y - middle) * share, z * share];
    },
  };
}

function cylinder(radius: number, half: number): ConvexBody {
  return {
    nearest([x, y, z]) {
      const away = Math.hypot(x, z), share = away > radius ? radius / away : 1;
      return [x * share, clamp(y, half), z * share];
    },
  };
}

/** A hull by its surface: inside where a point is behind all triangles. */
function hull(corners: readonly Vec3[], triangles: readonly (readonly [number, number, number])[]): ConvexBody {
  const at = (i: number): Vec3 => corners[i] ?? [0, 0, 0];
  const faces = triangles.map(([a, b, c]) => {
    const normal = cross(minus(at(b), at(a)), minus(at(c), at(a)));
    return { ends: [at(a), at(b), at(c)] as const, normal, offset: dot(normal, at(a)) };
  });
  return {
    nearest(point) {
      let best = point, least = Infinity;
      for (const { ends, normal, offset } of faces) {
        if (dot(normal, point) <= offset) continue;
        const found = nearestOnTriangle(point, ...ends), off = minus(point, found), square = dot(off, off);
        if (square < least) [best, least] = [found, square];
      }
      return best;
    },
  };
}

/** The point of a triangle nearest to a point, by the region that the point is in (Ericson, Real-Time Collision Detection, 5.1.5). */
export function nearestOnTriangle(p: Vec3, a: Vec3, b: Vec3, c: Vec3): Vec3 {
  const ab = minus(b, a), ac = minus(c, a), ap = minus(p, a);
  const d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const bp = minus(p, b), d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return plus(a, ab, d1 / (d1 - d3));
  const cp = minus(p, c), d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return plus(a, ac, d2 / (d2 - d6));
  const va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return plus(b, minus(c, b), (d4 - d3) / (d4 - d3 + (d5 - d6)));
  const whole = va + vb + vc;
  return plus(plus(a, ab, vb / whole), ac, vc / whole);
}

function clamp(value: number, half: number): number {
  return Math.min(half, Math.max(-half, value));
}

function minus(a: Vec3, b: Vec3): Vec3 {
  return [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
}

function plus(a: Vec3, b: Vec3, times: number): Vec3 {
  return [a[0] + b[0] * times, a[1] + b[1] * times, a[2] + b[2] * times];
}

function cross(a: Vec3, b: Vec3): Vec3 {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

function dot(a: Vec3, b: Vec3): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
