/** The scene's boxes as things to look at: softly bevelled, each kind of size in its own calm colour. */

import { Group, Mesh, MeshLambertMaterial, MeshStandardMaterial, Quaternion } from "three";
import { RoundedBoxGeometry } from "three/addons/geometries/RoundedBoxGeometry.js";
import { damp } from "../camera/damping";
import type { OrientedBox } from "../camera/spring_arm";
import type { Palette } from "./palette";

const BEVEL = 0.022;
const BEVEL_SEGMENTS = 2;
const SEE_THROUGH = 0.2;
const FADE_HALFLIFE = 0.09;
const GLOW = 0.5;

type BoxMesh = Mesh<RoundedBoxGeometry, MeshStandardMaterial | MeshLambertMaterial>;

export class Obstacles {
  readonly group = new Group();
  private marked: ReadonlySet<number> = new Set();
  private glow = 0;

  /** Replaces all boxes; `rich` ones have physically based surfaces. */
  build(boxes: readonly OrientedBox[], palette: Palette, rich: boolean): void {
    this.clear();
    this.glow = palette.touching;
    boxes.forEach((box, i) => {
      const colour = palette.obstacles[i % palette.obstacles.length] ?? 0x888888;
      this.group.add(boxMesh(box, colour, rich));
    });
    this.glowMarked();
  }

  /** Puts a box to another place, by number. */
  place(i: number, { center, rotation }: OrientedBox): void {
    const mesh = this.group.children[i];
    mesh?.position.set(...center);
    mesh?.quaternion.set(...rotation);
  }

  /** Lets some boxes glow, by number: those that close the way. */
  mark(boxes: ReadonlySet<number>): void {
    if (boxes.size === this.marked.size && [...boxes].every((i) => this.marked.has(i))) return;
    this.marked = boxes;
    this.glowMarked();
  }

  private glowMarked(): void {
    this.group.children.forEach((child, i) => {
      const { material } = child as BoxMesh;
      material.emissive.setHex(this.marked.has(i) ? this.glow : 0x000000);
      material.emissiveIntensity = GLOW;
    });
  }

  /** Moves each box towards see-through or solid; `hides` tells which box is in the way. */
  fade(hides: (i: number) => boolean, dt: number): void {
    this.group.children.forEach((child, i) => {
      const { material } = child as BoxMesh;
      const wanted = hides(i) ? SEE_THROUGH : 1;
      const opacity = Math.abs(material.opacity - wanted) < 0.01 ? wanted : damp(material.opacity, wanted, FADE_HALFLIFE, dt);
      if (opacity === material.opacity) return;
      if (material.transparent !== opacity < 1) material.needsUpdate = true;
      material.transparent = opacity < 1;
      material.depthWrite = opacity === 1;
      material.opacity = opacity;
    });
  }

  private clear(): void {
    for (const child of [...this.group.children]) {
      const mesh = child as BoxMesh;
      mesh.geometry.dispose();
      mesh.material.dispose();
      this.group.remove(mesh);
    }
  }
}

function boxMesh(box: OrientedBox, color: number, rich: boolean): Mesh {
  const [hx, hy, hz] = box.halfSize;
  const bevel = Math.min(BEVEL, 0.35 * Math.min(hx, hy, hz));
  const geometry = new RoundedBoxGeometry(2 * hx, 2 * hy, 2 * hz, BEVEL_SEGMENTS, bevel);
  const material = rich ? new MeshStandardMaterial({ color, roughness: 0.78 }) : new MeshLambertMaterial({ color });
  const mesh = new Mesh(geometry, material);
  mesh.position.set(...box.center);
  mesh.quaternion.copy(new Quaternion(...box.rotation));
  mesh.castShadow = mesh.receiveShadow = true;
  return mesh;
}
