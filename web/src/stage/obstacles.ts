/** The scene's obstacles as things to look at: boxes softly bevelled, each in its own calm colour. */

import {
  BufferGeometry, CapsuleGeometry, CylinderGeometry, Float32BufferAttribute, Group, Mesh, Quaternion, SphereGeometry,
} from "three";
import { RoundedBoxGeometry } from "three/addons/geometries/RoundedBoxGeometry.js";
import { damp } from "../camera/damping";
import type { OrientedBox } from "../camera/spring_arm";
import type { Form } from "../generated/messages";
import type { Leaving } from "./leaving";
import type { Palette } from "./palette";
import { solidMaterial, type SolidMaterial } from "./solid_material";

const BEVEL = 0.022;
const BEVEL_SEGMENTS = 2;
const SEE_THROUGH = 0.2;
const FADE_HALFLIFE = 0.09;
const GLOW = 0.5;
const ROUGHNESS = 0.78;

const ROUND = 48;

type ObstacleMesh = Mesh<BufferGeometry, SolidMaterial>;

/** What is drawn, and the box round it. */
export interface DrawnObstacle {
  readonly form: Form;
  readonly box: OrientedBox;
  /** "#rrggbb", or "" for the palette's. */
  readonly color: string;
}

export class Obstacles {
  readonly group = new Group();
  private marked: ReadonlySet<number> = new Set();
  private held: number | null = null;
  private glow = 0;
  private heldGlow = 0;

  constructor(private readonly leaving: Leaving) {}

  /** Replaces all obstacles; `rich` ones have physically based surfaces. */
  build(obstacles: readonly DrawnObstacle[], palette: Palette, rich: boolean): void {
    this.leaving.empty(this.group);
    this.glow = palette.touching;
    this.heldGlow = palette.accent;
    obstacles.forEach((obstacle, i) => {
      const chosen = palette.obstacles[i % palette.obstacles.length] ?? 0x888888;
      const colour = obstacle.color ? Number.parseInt(obstacle.color.slice(1), 16) : chosen;
      this.group.add(obstacleMesh(obstacle, colour, rich));
    });
    this.glowMarked();
  }

  /** Puts an obstacle to another place, by number. */
  place(i: number, { center, rotation }: OrientedBox): void {
    const mesh = this.group.children[i];
    mesh?.position.set(...center);
    mesh?.quaternion.set(...rotation);
  }

  /** Lets some obstacles glow, by number: those that close the way. */
  mark(numbers: ReadonlySet<number>): void {
    if (numbers.size === this.marked.size && [...numbers].every((i) => this.marked.has(i))) return;
    this.marked = numbers;
    this.glowMarked();
  }

  /** Lets the one glow that is in hand, by number. */
  hold(number: number | null): void {
    this.held = number;
    this.glowMarked();
  }

  private glowMarked(): void {
    this.group.children.forEach((child, i) => {
      const { material } = child as ObstacleMesh;
      material.emissive.setHex(this.marked.has(i) ? this.glow : i === this.held ? this.heldGlow : 0x000000);
      material.emissiveIntensity = GLOW;
    });
  }

  /** Moves each obstacle towards see-through or solid; `hides` tells which is in the way. */
  fade(hides: (i: number) => boolean, dt: number): void {
    this.group.children.forEach((child, i) => {
      const { material } = child as ObstacleMesh;
      const wanted = hides(i) ? SEE_THROUGH : 1;
      const opacity = Math.abs(material.opacity - wanted) < 0.01 ? wanted : damp(material.opacity, wanted, FADE_HALFLIFE, dt);
      if (opacity === material.opacity) return;
      if (material.transparent !== opacity < 1) material.needsUpdate = true;
      material.transparent = opacity < 1;
      material.depthWrite = opacity === 1;
      material.opacity = opacity;
    });
  }
}

function obstacleMesh({ form, box }: DrawnObstacle, color: number, rich: boolean): Mesh {
  const mesh = new Mesh(geometryOf(form), solidMaterial(color, ROUGHNESS, rich));
  mesh.position.set(...box.center);
  mesh.quaternion.copy(new Quaternion(...box.rotation));
  mesh.castShadow = mesh.receiveShadow = true;
  return mesh;
}

function geometryOf({ shape, size, corners, triangles }: Form): BufferGeometry {
  const [wide, high, deep] = size, radius = wide / 2;
  switch (shape) {
    case "box":
      return new RoundedBoxGeometry(wide, high, deep, BEVEL_SEGMENTS, Math.min(BEVEL, 0.175 * Math.min(wide, high, deep)));
    case "sphere":
      return new SphereGeometry(radius, ROUND, ROUND / 2);
    case "capsule":
      return new CapsuleGeometry(radius, high - wide, ROUND / 4, ROUND);
    case "cylinder":
      return new CylinderGeometry(radius, radius, high, ROUND);
    case "hull":
    case "mesh":
      return faceted(triangles.flatMap((triangle) => triangle.flatMap((i) => corners[i] ?? [0, 0, 0])));
  }
}

/** Triangles, nine numbers each, with a sharp edge between any two. */
function faceted(positions: readonly number[]): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(positions, 3));
  geometry.computeVertexNormals();
  return geometry;
}
