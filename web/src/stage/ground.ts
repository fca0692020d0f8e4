/** The floor: a wide field that fades into the horizon, and the scene's own slab with a metre grid on it. */

import {
  CanvasTexture, CircleGeometry, Color, Group, LinearFilter, LinearMipmapNearestFilter, Mesh, MeshBasicMaterial,
  MeshLambertMaterial, MultiplyBlending, PlaneGeometry, RepeatWrapping, SRGBColorSpace, type BufferGeometry,
} from "three";
import type { PreparedBox } from "../camera/spring_arm";
import { drawContactShadows } from "./contact_shadows";
import type { Palette } from "./palette";

const TILE_METRES = 5;
const TILE_PIXELS = 640;
const FIELD_RADIUS = 90;
const SHADOW_PIXELS_PER_METRE = 48;
const SHADOW_MAX_PIXELS = 1536;

type FloorMaterial = MeshLambertMaterial | MeshBasicMaterial;

export class Ground {
  readonly group = new Group();

  /** Lays the floor anew. `width` along x and `depth` along z in metres, round `center` (x, z). */
  lay(
    width: number, depth: number, center: readonly [number, number], boxes: readonly PreparedBox[], palette: Palette,
    rich: boolean,
  ): void {
    this.clear();
    const shadows = drawContactShadows(boxes, center, width, depth, shadowScale(width, depth), palette.contact);
    const plane = () => new PlaneGeometry(width, depth);
    if (rich) {
      this.add(plane(), new MeshLambertMaterial({ map: gridTexture(palette, width, depth, center) }), center, 0, 0);
      this.add(plane(), multiplied(shadows), center, 0.004, 1);
      this.add(new CircleGeometry(FIELD_RADIUS, 64), new MeshLambertMaterial({ color: palette.field }), center, -0.012, 0.5);
    } else {
      this.add(plane(), unlit(palette, paintedFloor(palette, shadows, width, depth, center)), center, 0, 0);
      const field = unlit(palette, null);
      field.color.multiply(new Color(palette.field));
      this.add(new CircleGeometry(FIELD_RADIUS, 64), field, center, -0.012, 0.5);
    }
  }

  private add(
    geometry: BufferGeometry, material: FloorMaterial, center: readonly [number, number], height: number, order: number,
  ): void {
    const mesh = new Mesh(geometry, material);
    mesh.rotation.x = -Math.PI / 2;
    mesh.position.set(center[0], height, center[1]);
    mesh.receiveShadow = true;
    mesh.renderOrder = order;
    this.group.add(mesh);
  }

  private clear(): void {
    for (const child of [...this.group.children]) {
      const mesh = child as Mesh<BufferGeometry, FloorMaterial>;
      mesh.geometry.dispose();
      mesh.material.map?.dispose();
      mesh.material.dispose();
      this.group.remove(mesh);
    }
  }
}

/** A flat floor without shadows has one brightness all over, so the cheap one is not lit but painted with it. */
function unlit(palette: Palette, map: CanvasTexture | null): MeshBasicMaterial {
  return new MeshBasicMaterial({ color: palette.floorLight, map, toneMapped: false });
}

/** Darkens what lies under it by the contact shadows. */
function multiplied(shadows: HTMLCanvasElement): MeshBasicMaterial {
  const map = new CanvasTexture(shadows);
  map.minFilter = LinearFilter;
  map.generateMipmaps = false;
  return new MeshBasicMaterial({
    map, transparent: true, depthWrite: false, toneMapped: false, fog: false, blending: MultiplyBlending,
    premultipliedAlpha: true,
  });
}

function shadowScale(width: number, depth: number): number {
  return Math.min(SHADOW_PIXELS_PER_METRE, SHADOW_MAX_PIXELS / Math.max(width, depth));
}

/** The tile of the metre grid; it repeats every `TILE_METRES`. */
function drawTile(palette: Palette): HTMLCanvasElement {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = TILE_PIXELS;
  const pen = canvas.getContext("2d");
  if (!pen) return canvas;
  pen.fillStyle = palette.slab;
  pen.fillRect(0, 0, TILE_PIXELS, TILE_PIXELS);
  const metre = TILE_PIXELS / TILE_METRES;
  for (let i = 0; i <= TILE_METRES; i++) {
    const bold = i % TILE_METRES === 0;
    pen.strokeStyle = bold ? palette.gridBold : palette.gridFine;
    pen.lineWidth = bold ? 5 : 3;
    pen.beginPath();
    pen.moveTo(i * metre, 0);
    pen.lineTo(i * metre, TILE_PIXELS);
    pen.moveTo(0, i * metre);
    pen.lineTo(TILE_PIXELS, i * metre);
    pen.stroke();
  }
  return canvas;
}

/** The grid as a repeating texture whose lines lie on whole metres of the world. */
function gridTexture(palette: Palette, width: number, depth: number, [x, z]: readonly [number, number]): CanvasTexture {
  const texture = new CanvasTexture(drawTile(palette));
  texture.colorSpace = SRGBColorSpace;
  texture.wrapS = texture.wrapT = RepeatWrapping;
  texture.repeat.set(width / TILE_METRES, depth / TILE_METRES);
  texture.offset.set((x - width / 2) / TILE_METRES, -(z + depth / 2) / TILE_METRES);
  texture.anisotropy = 8;
  return texture;
}

/** Grid and contact shadows in one picture, the cheapest floor to draw. */
function paintedFloor(
  palette: Palette, shadows: HTMLCanvasElement, width: number, depth: number, [x, z]: readonly [number, number],
): CanvasTexture {
  const pen = shadows.getContext("2d");
  const pattern = pen?.createPattern(drawTile(palette), "repeat");
  if (pen && pattern) {
    const scale = shadows.width / width;
    const shrink = (scale * TILE_METRES) / TILE_PIXELS;
    pattern.setTransform(new DOMMatrix([shrink, 0, 0, shrink, (width / 2 - x) * scale, (depth / 2 - z) * scale]));
    pen.resetTransform();
    pen.filter = "none";
    pen.globalAlpha = 1;
    pen.globalCompositeOperation = "multiply";
    pen.fillStyle = pattern;
    pen.fillRect(0, 0, shadows.width, shadows.height);
  }
  const texture = new CanvasTexture(shadows);
  texture.colorSpace = SRGBColorSpace;
  texture.minFilter = LinearMipmapNearestFilter;
  return texture;
}
