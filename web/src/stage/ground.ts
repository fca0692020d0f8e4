/** The floor: a field without an end that fades into the horizon, and on it the scene's own slab; both with a metre grid. */

import {
  CanvasTexture, Group, LinearFilter, LinearMipmapLinearFilter, LinearMipmapNearestFilter, Mesh, MeshBasicMaterial,
  MeshLambertMaterial, MultiplyBlending, PlaneGeometry, RepeatWrapping, SRGBColorSpace, type BufferGeometry,
} from "three";
import type { PreparedBox } from "../camera/spring_arm";
import { drawContactShadows } from "./contact_shadows";
import { FIELD_REACH, FIELD_TILE, fieldMiddle } from "./field";
import type { Leaving } from "./leaving";
import type { Palette } from "./palette";

const TILE_METRES = 5;
const TILE_PIXELS = 640;
const FIELD_TILE_PIXELS = 512;
const FIELD_SQUARES = FIELD_TILE / TILE_METRES; // of alternating tone along a side of the field's tile
const SHADOW_PIXELS_PER_METRE = 48;
const SHADOW_MAX_PIXELS = 1536;

type FloorMaterial = MeshLambertMaterial | MeshBasicMaterial;

export class Ground {
  readonly group = new Group();
  private field: Mesh | null = null;

  constructor(private readonly leaving: Leaving) {}

  /** Brings the field along, in whole tiles: its lines stay where they are. */
  follow(x: number, z: number): void {
    this.field?.position.setX(fieldMiddle(x)).setZ(fieldMiddle(z));
  }

  /** Lays the floor anew. `width` along x and `depth` along z in metres, round `center` (x, z). */
  lay(
    width: number, depth: number, center: readonly [number, number], boxes: readonly PreparedBox[], palette: Palette,
    rich: boolean,
  ): void {
    this.leaving.empty(this.group);
    const shadows = drawContactShadows(boxes, center, width, depth, shadowScale(width, depth), palette.contact);
    const plane = () => new PlaneGeometry(width, depth);
    if (rich) {
      this.add(plane(), new MeshLambertMaterial({ map: gridTexture(palette, width, depth, center) }), center, 0, 0);
      this.add(plane(), multiplied(shadows), center, 0.004, 1);
    } else {
      this.add(plane(), unlit(palette, paintedFloor(palette, shadows, width, depth, center)), center, 0, 0);
    }
    const map = fieldTexture(palette, rich);
    const field = new PlaneGeometry(2 * FIELD_REACH, 2 * FIELD_REACH);
    this.field = this.add(field, rich ? new MeshLambertMaterial({ map }) : unlit(palette, map), [0, 0], -0.012, 0.5);
    this.follow(...center);
  }

  private add(
    geometry: BufferGeometry, material: FloorMaterial, center: readonly [number, number], height: number, order: number,
  ): Mesh {
    const mesh = new Mesh(geometry, material);
    mesh.rotation.x = -Math.PI / 2;
    mesh.position.set(center[0], height, center[1]);
    mesh.receiveShadow = true;
    mesh.renderOrder = order;
    this.group.add(mesh);
    return mesh;
  }
}

/** A flat floor without shadows has one brightness all over, so the cheap one is not lit but painted with it. */
function unlit(palette: Palette, map: CanvasTexture): MeshBasicMaterial {
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

/** The field's tile: squares of two tones with a faint metre grid; its corners lie on whole multiples of its size. */
function fieldTexture(palette: Palette, rich: boolean): CanvasTexture {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = FIELD_TILE_PIXELS;
  const pen = canvas.getContext("2d");
  if (pen) {
    const square = FIELD_TILE_PIXELS / FIELD_SQUARES;
    for (let i = 0; i < FIELD_SQUARES * FIELD_SQUARES; i++) {
      const [column, row] = [i % FIELD_SQUARES, Math.floor(i / FIELD_SQUARES)];
      pen.fillStyle = palette.field[((column + row) % 2) as 0 | 1];
      pen.fillRect(column * square, row * square, square, square);
    }
    drawLines(pen, palette, FIELD_TILE_PIXELS, FIELD_TILE, [2, 3]);
  }
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  texture.wrapS = texture.wrapT = RepeatWrapping;
  texture.repeat.setScalar((2 * FIELD_REACH) / FIELD_TILE);
  texture.minFilter = rich ? LinearMipmapLinearFilter : LinearMipmapNearestFilter;
  texture.anisotropy = rich ? 8 : 1;
  return texture;
}

/** The tile of the metre grid; it repeats every `TILE_METRES`. */
function drawTile(palette: Palette): HTMLCanvasElement {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = TILE_PIXELS;
  const pen = canvas.getContext("2d");
  if (!pen) return canvas;
  pen.fillStyle = palette.slab;
  pen.fillRect(0, 0, TILE_PIXELS, TILE_PIXELS);
  drawLines(pen, palette, TILE_PIXELS, TILE_METRES, [3, 5]);
  return canvas;
}

/** A line every metre, a bold one every `TILE_METRES`. */
function drawLines(
  pen: CanvasRenderingContext2D, palette: Palette, pixels: number, metres: number, widths: readonly [fine: number, bold: number],
): void {
  const metre = pixels / metres;
  for (let i = 0; i <= metres; i++) {
    const bold = i % TILE_METRES === 0;
    pen.strokeStyle = bold ? palette.gridBold : palette.gridFine;
    pen.lineWidth = bold ? widths[1] : widths[0];
    pen.beginPath();
    pen.moveTo(i * metre, 0);
    pen.lineTo(i * metre, pixels);
    pen.moveTo(0, i * metre);
    pen.lineTo(pixels, i * metre);
    pen.stroke();
  }
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
