/** The finish: two posts with a chequered banner, a band across the floor, and a carpet beyond; nothing like an obstacle. */

import {
  BoxGeometry, CanvasTexture, CylinderGeometry, DoubleSide, Group, LinearFilter, Mesh, MeshBasicMaterial, NearestFilter,
  PlaneGeometry, RingGeometry, SRGBColorSpace, type Texture,
} from "three";
import type { Leaving } from "./leaving";
import type { Palette } from "./palette";
import { solidMaterial } from "./solid_material";

const HEIGHT = 3.05; // the camera from behind passes under the banner
const BANNER = 0.42;
const POST = 0.035;
const SQUARE = 0.14; // of the chequered band, metres
const BAND_ROWS = 4;
const CARPET = 6;
const ROUGHNESS = 0.5;

/** Where a gate stands and which way one walks through it. */
export interface GatePlace {
  readonly position: readonly [number, number];
  readonly heading: number;
  readonly width: number;
}

export class Gate {
  readonly group = new Group();
  private curtain: MeshBasicMaterial | null = null;
  private glow = 0;

  constructor(private readonly leaving: Leaving) {}

  build(finish: GatePlace | null, start: readonly [number, number], palette: Palette, rich: boolean): void {
    this.curtain = null;
    this.leaving.empty(this.group);
    this.group.add(startRing(start, palette));
    if (!finish) return;
    const gate = new Group();
    gate.position.set(finish.position[0], 0, finish.position[1]);
    gate.rotation.y = finish.heading;
    this.curtain = new MeshBasicMaterial({
      map: fadingTexture("up"), color: palette.accent, transparent: true, opacity: 0.22, side: DoubleSide,
      depthWrite: false, toneMapped: false,
    });
    const curtain = new Mesh(new PlaneGeometry(finish.width - 2 * POST, HEIGHT - BANNER), this.curtain);
    curtain.position.y = (HEIGHT - BANNER) / 2;
    curtain.renderOrder = 3;
    gate.add(...frame(finish.width, palette, rich), curtain, band(finish.width, palette), carpet(finish.width, palette));
    this.group.add(gate);
  }

  /** Brightens the gate for a moment: the avatar went through. */
  flash(): void {
    this.glow = 1;
  }

  update(dt: number): void {
    if (!this.curtain) return;
    this.glow = Math.max(0, this.glow - dt / 1.6);
    this.curtain.opacity = 0.22 + 0.6 * this.glow * this.glow;
  }
}

/** Posts and banner; the word is readable from both sides. */
function frame(width: number, palette: Palette, rich: boolean): Mesh[] {
  const solid = solidMaterial(palette.accent, ROUGHNESS, rich);
  const posts = [-1, 1].map((side) => {
    const post = new Mesh(new CylinderGeometry(POST, POST, HEIGHT, 16), solid);
    post.position.set((side * width) / 2, HEIGHT / 2, 0);
    post.castShadow = true;
    return post;
  });
  const board = new Mesh(new BoxGeometry(width, BANNER, 0.02), solid);
  board.position.y = HEIGHT - BANNER / 2;
  board.castShadow = true;
  const cloth = new MeshBasicMaterial({ map: bannerTexture(width, palette), toneMapped: false });
  const faces = [0, Math.PI].map((turn) => {
    const face = new Mesh(new PlaneGeometry(width, BANNER), cloth);
    face.position.set(0, HEIGHT - BANNER / 2, 0.012 * Math.cos(turn));
    face.rotation.y = turn;
    return face;
  });
  return [...posts, board, ...faces];
}

function startRing(start: readonly [number, number], palette: Palette): Mesh {
  const ring = new Mesh(
    new RingGeometry(0.36, 0.4, 48),
    new MeshBasicMaterial({ color: palette.accent, transparent: true, opacity: 0.45, depthWrite: false }),
  );
  onFloor(ring, 0.008);
  ring.position.setX(start[0]).setZ(start[1]);
  return ring;
}

/** Black and white squares on the floor, under the banner. */
function band(width: number, palette: Palette): Mesh {
  const columns = Math.max(2, Math.round(width / SQUARE));
  const canvas = document.createElement("canvas");
  canvas.width = columns;
  canvas.height = BAND_ROWS;
  const pen = canvas.getContext("2d");
  if (pen) chequer(pen, [0, 0], 1, columns, BAND_ROWS, palette);
  const texture = coloured(canvas);
  texture.magFilter = NearestFilter;
  const mesh = new Mesh(
    new PlaneGeometry(width, BAND_ROWS * SQUARE),
    new MeshBasicMaterial({ map: texture, transparent: true, opacity: 0.85, depthWrite: false, toneMapped: false }),
  );
  onFloor(mesh, 0.007);
  return mesh;
}

/** The run-out: a carpet beyond the line, which fades away. */
function carpet(width: number, palette: Palette): Mesh {
  const material = new MeshBasicMaterial({
    map: fadingTexture("down"), color: palette.accent, transparent: true, opacity: 0.3, depthWrite: false, toneMapped: false,
  });
  const mesh = new Mesh(new PlaneGeometry(width, CARPET), material);
  onFloor(mesh, 0.006);
  mesh.position.z = CARPET / 2 + (BAND_ROWS * SQUARE) / 2;
  return mesh;
}

function onFloor(mesh: Mesh, height: number): void {
  mesh.rotation.x = -Math.PI / 2;
  mesh.position.y = height;
  mesh.renderOrder = 2;
}

/** "FINISH" between chequered ends. */
function bannerTexture(width: number, palette: Palette): CanvasTexture {
  const canvas = document.createElement("canvas");
  canvas.height = 96;
  canvas.width = Math.min(2048, Math.round((canvas.height * width) / BANNER));
  const pen = canvas.getContext("2d");
  if (pen) {
    const square = canvas.height / 3;
    const ends = Math.max(1, Math.floor(canvas.width / 4 / square));
    pen.fillStyle = palette.banner[0];
    pen.fillRect(0, 0, canvas.width, canvas.height);
    for (const x of [0, canvas.width - ends * square]) chequer(pen, [x, 0], square, ends, 3, palette);
    pen.fillStyle = palette.banner[1];
    pen.font = `800 ${0.62 * canvas.height}px system-ui, "DejaVu Sans", sans-serif`;
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.fillText("FINISH", canvas.width / 2, 0.53 * canvas.height, canvas.width / 2.1);
  }
  return coloured(canvas);
}

function chequer(
  pen: CanvasRenderingContext2D, [left, top]: readonly [number, number], size: number, columns: number, rows: number, palette: Palette,
): void {
  for (let i = 0; i < columns * rows; i++) {
    const [column, row] = [i % columns, Math.floor(i / columns)];
    pen.fillStyle = palette.banner[((column + row) % 2) as 0 | 1];
    pen.fillRect(left + column * size, top + row * size, size, size);
  }
}

function coloured(canvas: HTMLCanvasElement): CanvasTexture {
  const texture = new CanvasTexture(canvas);
  texture.generateMipmaps = false;
  texture.minFilter = LinearFilter;
  texture.colorSpace = SRGBColorSpace;
  return texture;
}

/** White that fades upwards or downwards into nothing. */
function fadingTexture(to: "up" | "down"): Texture {
  const canvas = document.createElement("canvas");
  canvas.width = 1;
  canvas.height = 64;
  const pen = canvas.getContext("2d");
  if (pen) {
    const gradient = pen.createLinearGradient(0, 0, 0, 64);
    gradient.addColorStop(to === "up" ? 0 : 1, "rgba(255,255,255,0)");
    gradient.addColorStop(to === "up" ? 1 : 0, "rgba(255,255,255,1)");
    pen.fillStyle = gradient;
    pen.fillRect(0, 0, 1, 64);
  }
  return new CanvasTexture(canvas);
}
