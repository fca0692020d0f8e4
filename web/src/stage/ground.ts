/** The floor: a wide field that fades into the horizon, and the scene's own slab with a metre grid on it. */

import {
  CanvasTexture, CircleGeometry, Color, Group, LinearFilter, LinearMipmapLinearFilter, Mesh, MeshBasicMaterial,
  MeshLambertMaterial, PlaneGeometry, RepeatWrapping, SRGBColorSpace,
} from "three";
import type { PreparedBox } from "../camera/spring_arm";
import { drawContactShadows } from "./contact_shadows";
import type { Palette } from "./palette";

const TILE_METRES = 5;
const TILE_PIXELS = 640;
const FIELD_RADIUS = 90;
const SHADOW_PIXELS_PER_METRE = 48;
const SHADOW_MAX_PIXELS = 1536;

export class Ground {
  readonly group = new Group();
  private readonly field = new Mesh(new CircleGeometry(FIELD_RADIUS, 64), new MeshLambertMaterial());
  private slab: Mesh<PlaneGeometry, MeshLambertMaterial> | null = null;
  private contact: Mesh<PlaneGeometry, MeshBasicMaterial> | null = null;

  constructor() {
    this.field.rotation.x = -Math.PI / 2;
    this.field.position.y = -0.012;
    this.group.add(this.field);
  }

  /** Lays the floor anew. `width` along x and `depth` along z in metres, round `center` (x, z). */
  lay(width: number, depth: number, center: readonly [number, number], boxes: readonly PreparedBox[], palette: Palette): void {
    this.clear();
    this.field.material.color.set(palette.field);
    this.field.position.set(center[0], -0.012, center[1]);
    this.slab = new Mesh(new PlaneGeometry(width, depth), new MeshLambertMaterial({ map: gridTexture(palette, width, depth) }));
    this.slab.rotation.x = -Math.PI / 2;
    this.slab.position.set(center[0], 0, center[1]);
    this.slab.receiveShadow = true;
    this.contact = contactMesh(width, depth, center, boxes, palette);
    this.group.add(this.slab, this.contact);
  }

  private clear(): void {
    for (const mesh of [this.slab, this.contact]) {
      if (!mesh) continue;
      this.group.remove(mesh);
      mesh.geometry.dispose();
      mesh.material.map?.dispose();
      mesh.material.dispose();
    }
  }
}

function gridTexture(palette: Palette, width: number, depth: number): CanvasTexture {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = TILE_PIXELS;
  const pen = canvas.getContext("2d");
  if (pen) {
    pen.fillStyle = palette.slab;
    pen.fillRect(0, 0, TILE_PIXELS, TILE_PIXELS);
    const metre = TILE_PIXELS / TILE_METRES;
    for (let i = 0; i <= TILE_METRES; i++) {
      pen.strokeStyle = i % TILE_METRES === 0 ? palette.gridBold : palette.gridFine;
      pen.lineWidth = i % TILE_METRES === 0 ? 4 : 2.5;
      pen.beginPath();
      pen.moveTo(i * metre, 0);
      pen.lineTo(i * metre, TILE_PIXELS);
      pen.moveTo(0, i * metre);
      pen.lineTo(TILE_PIXELS, i * metre);
      pen.stroke();
    }
  }
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  texture.wrapS = texture.wrapT = RepeatWrapping;
  texture.repeat.set(width / TILE_METRES, depth / TILE_METRES);
  texture.offset.set(((-width / 2) / TILE_METRES) % 1, ((-depth / 2) / TILE_METRES) % 1);
  texture.anisotropy = 8;
  texture.minFilter = LinearMipmapLinearFilter;
  return texture;
}

function contactMesh(
  width: number, depth: number, center: readonly [number, number], boxes: readonly PreparedBox[], palette: Palette,
): Mesh<PlaneGeometry, MeshBasicMaterial> {
  const scale = Math.min(SHADOW_PIXELS_PER_METRE, SHADOW_MAX_PIXELS / Math.max(width, depth));
  const canvas = drawContactShadows(boxes, center, width, depth, scale);
  const texture = new CanvasTexture(canvas);
  texture.minFilter = LinearFilter;
  texture.generateMipmaps = false;
  const material = new MeshBasicMaterial({
    map: texture, color: new Color(palette.contact), transparent: true, depthWrite: false, toneMapped: false,
  });
  const mesh = new Mesh(new PlaneGeometry(width, depth), material);
  mesh.rotation.x = -Math.PI / 2;
  mesh.position.set(center[0], 0.004, center[1]);
  mesh.renderOrder = 1;
  return mesh;
}
