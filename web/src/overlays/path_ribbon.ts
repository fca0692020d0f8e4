/** The planned root path: a ribbon on the floor with an arrow head at each key frame. */

import {
  BufferAttribute, BufferGeometry, CatmullRomCurve3, DoubleSide, Mesh, MeshBasicMaterial, Vector3,
} from "three";

const HEIGHT = 0.014;
const HALF_WIDTH = 0.035;
const ARROW = 0.11;
const SAMPLES_PER_KEY = 6;

export class PathRibbon {
  readonly mesh: Mesh<BufferGeometry, MeshBasicMaterial>;

  constructor(color: number) {
    const material = new MeshBasicMaterial({
      color, transparent: true, opacity: 0.85, depthWrite: false, side: DoubleSide, toneMapped: false,
    });
    this.mesh = new Mesh(new BufferGeometry(), material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 3;
    this.mesh.visible = false;
  }

  /**
   * @param keys x, z, heading of each key frame
   * @param heights of the ground there
   */
  show(keys: readonly (readonly [number, number, number])[], heights: readonly number[]): void {
    const corners: number[] = [];
    const points = keys.map(([x, z], i) => new Vector3(x, (heights[i] ?? 0) + HEIGHT, z));
    const moved = points.length > 1 && points.some((p) => p.distanceTo(points[0] as Vector3) > 0.02);
    if (moved) addBand(corners, new CatmullRomCurve3(points, false, "centripetal").getPoints(points.length * SAMPLES_PER_KEY));
    keys.forEach(([x, z, heading], i) => {
      if (i > 0) addArrow(corners, x, heights[i] ?? 0, z, heading);
    });
    this.mesh.visible = corners.length > 0;
    this.mesh.geometry.dispose();
    this.mesh.geometry = new BufferGeometry();
    this.mesh.geometry.setAttribute("position", new BufferAttribute(new Float32Array(corners), 3));
  }

  dispose(): void {
    this.mesh.removeFromParent();
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}

function addBand(corners: number[], points: readonly Vector3[]): void {
  let last: [Vector3, Vector3] | null = null;
  points.forEach((point, i) => {
    const next = points[i + 1] ?? point;
    const before = points[i - 1] ?? point;
    const across = new Vector3(next.z - before.z, 0, before.x - next.x).setLength(HALF_WIDTH);
    const edges: [Vector3, Vector3] = [point.clone().add(across), point.clone().sub(across)];
    if (last) {
      for (const p of [last[0], last[1], edges[0], edges[0], last[1], edges[1]]) corners.push(p.x, p.y, p.z);
    }
    last = edges;
  });
}

function addArrow(corners: number[], x: number, floor: number, z: number, heading: number): void {
  const forward: [number, number] = [Math.sin(heading), Math.cos(heading)];
  const left: [number, number] = [forward[1], -forward[0]];
  const at = (ahead: number, aside: number) => {
    corners.push(x + forward[0] * ahead + left[0] * aside, floor + HEIGHT + 0.002, z + forward[1] * ahead + left[1] * aside);
  };
  at(ARROW, 0);
  at(-ARROW * 0.6, ARROW * 0.75);
  at(-ARROW * 0.6, -ARROW * 0.75);
}
