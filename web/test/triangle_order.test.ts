import { BufferAttribute, BufferGeometry, PlaneGeometry } from "three";
import { describe, expect, it } from "vitest";
import { orderGeometry, orderTriangles } from "../src/avatar/triangle_order";

/** Vertices that a first-in-first-out cache must compute, per triangle. */
function missesPerTriangle(indices: ArrayLike<number>, cacheSize = 16): number {
  const cache: number[] = [];
  let misses = 0;
  for (let i = 0; i < indices.length; i++) {
    const vertex = indices[i] ?? 0;
    if (cache.includes(vertex)) continue;
    misses++;
    cache.push(vertex);
    if (cache.length > cacheSize) cache.shift();
  }
  return misses / (indices.length / 3);
}

/** Triangles as corner positions, independent of order and numbering. */
function shape(geometry: BufferGeometry): string[] {
  const position = geometry.getAttribute("position");
  const corner = (i: number) => [position.getX(i), position.getY(i), position.getZ(i)].map((v) => v.toFixed(4)).join();
  const index = geometry.index?.array ?? [];
  const triangles: string[] = [];
  for (let i = 0; i < index.length; i += 3) {
    const corners = [0, 1, 2].map((k) => corner(index[i + k] ?? 0));
    const first = corners.indexOf([...corners].sort()[0] ?? "");
    triangles.push([...corners.slice(first), ...corners.slice(0, first)].join(" "));
  }
  return triangles.sort();
}

/** A grid whose triangles come in a scattered order. */
function scattered(): BufferGeometry {
  const grid = new PlaneGeometry(1, 1, 40, 40);
  const index = [...(grid.index?.array ?? [])];
  const count = index.length / 3;
  const order = Array.from({ length: count }, (_, i) => (i * 7919) % count);
  grid.setIndex(order.flatMap((t) => index.slice(3 * t, 3 * t + 3)));
  return grid;
}

describe("orderTriangles", () => {
  it("keeps every triangle and halves the vertices to compute at least", () => {
    const grid = scattered();
    const before = grid.index?.array ?? [];
    const after = orderTriangles(before, grid.getAttribute("position").count);
    expect(after.length).toBe(before.length);
    expect(missesPerTriangle(before)).toBeGreaterThan(2);
    expect(missesPerTriangle(after)).toBeLessThan(1);
  });
});

describe("orderGeometry", () => {
  it("draws the same surface, with its morph targets", () => {
    const grid = scattered();
    const moved = Float32Array.from(grid.getAttribute("position").array, (v) => 2 * v);
    grid.morphAttributes["position"] = [new BufferAttribute(moved, 3)];
    const before = shape(grid);
    orderGeometry(grid);
    expect(shape(grid)).toEqual(before);
    const position = grid.getAttribute("position").array;
    const morphed = grid.morphAttributes["position"]?.[0]?.array ?? [];
    for (let i = 0; i < position.length; i++) expect(morphed[i]).toBeCloseTo(2 * (position[i] ?? 0), 6);
  });

  it("leaves small geometries alone", () => {
    const small = new PlaneGeometry(1, 1, 2, 2);
    const { index } = small;
    orderGeometry(small);
    expect(small.index).toBe(index);
  });
});
