/**
 * Orders an avatar's triangles so that neighbours are drawn one after another: each vertex is then skinned about once
 * instead of two or three times, which is what drawing a detailed avatar in software costs most.
 *
 * Tipsify: Sander, Nehab & Barczak, "Fast triangle reordering for vertex locality and reduced overdraw", SIGGRAPH 2007.
 */

import { BufferAttribute, type BufferGeometry } from "three";

const CACHE = 14;
const WORTH_IT = 500;

/** The same triangles in another order, as indices three by three. */
export function orderTriangles(indices: ArrayLike<number>, vertexCount: number, cacheSize = CACHE): Uint32Array {
  const { starts, triangles } = trianglesByVertex(indices, vertexCount);
  const live = Uint32Array.from({ length: vertexCount }, (_, v) => (starts[v + 1] ?? 0) - (starts[v] ?? 0));
  const stamps = new Int32Array(vertexCount);
  const emitted = new Uint8Array(indices.length / 3);
  const deadEnds: number[] = [];
  const out = new Uint32Array(indices.length);
  let filled = 0;
  let time = cacheSize + 1;
  let cursor = 0;
  for (let fan = 0; fan >= 0; ) {
    const candidates: number[] = [];
    for (let k = starts[fan] ?? 0; k < (starts[fan + 1] ?? 0); k++) {
      const triangle = triangles[k] ?? 0;
      if (emitted[triangle]) continue;
      emitted[triangle] = 1;
      for (let corner = 0; corner < 3; corner++) {
        const vertex = indices[3 * triangle + corner] ?? 0;
        out[filled++] = vertex;
        deadEnds.push(vertex);
        candidates.push(vertex);
        live[vertex] = (live[vertex] ?? 0) - 1;
        if (time - (stamps[vertex] ?? 0) > cacheSize) stamps[vertex] = time++;
      }
    }
    fan = bestFan(candidates, live, stamps, time, cacheSize);
    while (fan < 0 && deadEnds.length > 0) {
      const vertex = deadEnds.pop() ?? 0;
      if ((live[vertex] ?? 0) > 0) fan = vertex;
    }
    while (fan < 0 && cursor < vertexCount) {
      if ((live[cursor] ?? 0) > 0) fan = cursor;
      cursor++;
    }
  }
  return out;
}

/** Reorders a geometry's triangles, and its vertices by first use. Small or shared geometries stay as they are. */
export function orderGeometry(geometry: BufferGeometry): void {
  const { index } = geometry;
  const position = geometry.getAttribute("position");
  const attributes = [geometry.attributes, ...morphSets(geometry)];
  const plain = attributes.every((set) => Object.values(set).every((attribute) => attribute instanceof BufferAttribute));
  if (!index || !plain || index.count < 3 * WORTH_IT || geometry.groups.length > 0) return;
  const ordered = orderTriangles(index.array, position.count);
  const { renumbered, oldNumbers } = byFirstUse(ordered, position.count);
  geometry.setIndex(new BufferAttribute(renumbered, 1));
  for (const set of attributes) {
    for (const [name, attribute] of Object.entries(set)) set[name] = pick(attribute as BufferAttribute, oldNumbers);
  }
}

function trianglesByVertex(indices: ArrayLike<number>, vertexCount: number) {
  const starts = new Uint32Array(vertexCount + 1);
  for (let i = 0; i < indices.length; i++) starts[(indices[i] ?? 0) + 1]!++;
  for (let v = 0; v < vertexCount; v++) starts[v + 1] = (starts[v + 1] ?? 0) + (starts[v] ?? 0);
  const next = starts.slice();
  const triangles = new Uint32Array(indices.length);
  for (let i = 0; i < indices.length; i++) triangles[next[indices[i] ?? 0]!++] = Math.floor(i / 3);
  return { starts, triangles };
}

/** The candidate that has been in the cache longest and will still be there when its triangles are drawn. */
function bestFan(
  candidates: readonly number[], live: Uint32Array, stamps: Int32Array, time: number, cacheSize: number,
): number {
  let best = -1;
  let bestAge = -1;
  for (const vertex of candidates) {
    const left = live[vertex] ?? 0;
    if (left === 0) continue;
    const age = time - (stamps[vertex] ?? 0);
    const priority = age + 2 * left <= cacheSize ? age : 0;
    if (priority > bestAge) {
      bestAge = priority;
      best = vertex;
    }
  }
  return best;
}

function byFirstUse(indices: Uint32Array, vertexCount: number) {
  const newNumbers = new Int32Array(vertexCount).fill(-1);
  const oldNumbers: number[] = [];
  const renumbered = indices.map((vertex) => {
    if ((newNumbers[vertex] ?? -1) < 0) newNumbers[vertex] = oldNumbers.push(vertex) - 1;
    return newNumbers[vertex] ?? 0;
  });
  return { renumbered, oldNumbers };
}

/** Each list of morph targets as a record, so that it can be treated like the plain attributes. */
function morphSets(geometry: BufferGeometry): Record<string, unknown>[] {
  return Object.values(geometry.morphAttributes) as unknown as Record<string, unknown>[];
}

function pick(attribute: BufferAttribute, oldNumbers: readonly number[]): BufferAttribute {
  const { itemSize, array } = attribute;
  const picked = array.slice(0, oldNumbers.length * itemSize);
  oldNumbers.forEach((old, now) => {
    for (let k = 0; k < itemSize; k++) picked[now * itemSize + k] = array[old * itemSize + k] ?? 0;
  });
  const copy = new BufferAttribute(picked, itemSize, attribute.normalized);
  copy.name = attribute.name;
  copy.gpuType = attribute.gpuType;
  return copy;
}
