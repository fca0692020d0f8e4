/** The floor: a wide field that fades into the horizon, and the scene's own slab with a metre grid on it. */

import {
  CanvasTexture, CircleGeometry, Color, Group, LinearFilter, LinearMipmapLinearFilter, Mesh, MeshBasicMaterial,
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
    const grid = gridTexture(palette, width, depth, rich);
    const contact = contactTexture(width, depth, center, boxes, palette);
    const slab = floorMaterial(new Color(0xffffff), palette, rich);
    slab.map = grid;
    this.add(new PlaneGeometry(width, depth), slab, center, 0, 0);
    this.add(new CircleGeometry(FIELD_RADIUS, 64), floorMaterial(new Color(palette.field), palette, rich), center, -0.012, 0.5);
    if (rich) this.addContact(width, depth, center, contact);
    else {
      slab.aoMap = contact;
    }
  }

  private addContact(width: number, depth: number, center: readonly [number, number], contact: CanvasTexture): void {
    const material = new MeshBasicMaterial({
      map: contact, transparent: true, depthWrite: false, toneMapped: false, blending: MultiplyBlending,
      premultipliedAlpha: true,
    });
    this.add(new PlaneGeometry(width, depth), material, center, 0.004, 1);
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
      mesh.material.aoMap?.dispose();
      mesh.material.dispose();
      this.group.remove(mesh);
    }
  }
}

/** A flat floor without shadows has one brightness all over, so the cheap one is not lit but painted with it. */
function floorMaterial(color: Color, palette: Palette, rich: boolean): FloorMaterial {
  if (rich) return new MeshLambertMaterial({ color });
  return new MeshBasicMaterial({ color: color.multiply(new Color(palette.floorLight)) });
}

function gridTexture(palette: Palette, width: number, depth: number, rich: boolean): CanvasTexture {
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
  texture.anisotropy = rich ? 8 : 1;
  texture.minFilter = LinearMipmapLinearFilter;
  return texture;
}

function contactTexture(
  width: number, depth: number, center: readonly [number, number], boxes: readonly PreparedBox[], palette: Palette,
): CanvasTexture {
  const scale = Math.min(SHADOW_PIXELS_PER_METRE, SHADOW_MAX_PIXELS / Math.max(width, depth));
  const texture = new CanvasTexture(drawContactShadows(boxes, center, width, depth, scale, palette.contact));
  texture.minFilter = LinearFilter;
  texture.generateMipmaps = false;
  return texture;
}
