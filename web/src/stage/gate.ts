/** The finish: two slim posts, a lintel and a band of light on the floor; nothing that looks like an obstacle. */

import {
  BoxGeometry, CanvasTexture, CylinderGeometry, DoubleSide, Group, LinearFilter, Mesh, MeshBasicMaterial,
  MeshStandardMaterial, NearestFilter, PlaneGeometry, RingGeometry, SRGBColorSpace,
} from "three";
import type { Palette } from "./palette";

const HEIGHT = 2.35;
const POST = 0.035;

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

  build(finish: GatePlace | null, start: readonly [number, number], palette: Palette): void {
    this.group.clear();
    this.curtain = null;
    this.group.add(startRing(start, palette));
    if (!finish) return;
    const gate = new Group();
    gate.position.set(finish.position[0], 0, finish.position[1]);
    gate.rotation.y = finish.heading;
    const solid = new MeshStandardMaterial({ color: palette.accent, roughness: 0.5 });
    const half = finish.width / 2;
    for (const side of [-1, 1]) {
      const post = new Mesh(new CylinderGeometry(POST, POST, HEIGHT, 16), solid);
      post.position.set(side * half, HEIGHT / 2, 0);
      post.castShadow = true;
      gate.add(post);
    }
    const lintel = new Mesh(new BoxGeometry(finish.width + 2 * POST, 2 * POST, 2 * POST), solid);
    lintel.position.y = HEIGHT;
    lintel.castShadow = true;
    this.curtain = new MeshBasicMaterial({
      map: fadeUpTexture(), color: palette.accent, transparent: true, opacity: 0.22, side: DoubleSide,
      depthWrite: false, toneMapped: false,
    });
    const curtain = new Mesh(new PlaneGeometry(finish.width - 2 * POST, HEIGHT), this.curtain);
    curtain.position.y = HEIGHT / 2;
    curtain.renderOrder = 3;
    gate.add(lintel, curtain, threshold(finish.width, palette));
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

function startRing(start: readonly [number, number], palette: Palette): Mesh {
  const ring = new Mesh(
    new RingGeometry(0.36, 0.4, 48),
    new MeshBasicMaterial({ color: palette.accent, transparent: true, opacity: 0.45, depthWrite: false }),
  );
  ring.rotation.x = -Math.PI / 2;
  ring.position.set(start[0], 0.008, start[1]);
  ring.renderOrder = 2;
  return ring;
}

/** A chequered band on the floor under the gate. */
function threshold(width: number, palette: Palette): Mesh {
  const canvas = document.createElement("canvas");
  canvas.width = 32;
  canvas.height = 2;
  const pen = canvas.getContext("2d");
  if (pen) {
    pen.fillStyle = "#fff";
    for (let x = 0; x < 32; x++) pen.fillRect(x, x % 2, 1, 1);
  }
  const texture = new CanvasTexture(canvas);
  texture.magFilter = NearestFilter;
  texture.generateMipmaps = false;
  texture.minFilter = LinearFilter;
  texture.colorSpace = SRGBColorSpace;
  const band = new Mesh(
    new PlaneGeometry(width, width / 16),
    new MeshBasicMaterial({
      map: texture, color: palette.accent, transparent: true, opacity: 0.75, depthWrite: false, toneMapped: false,
    }),
  );
  band.rotation.x = -Math.PI / 2;
  band.position.y = 0.007;
  band.renderOrder = 2;
  return band;
}

function fadeUpTexture(): CanvasTexture {
  const canvas = document.createElement("canvas");
  canvas.width = 1;
  canvas.height = 64;
  const pen = canvas.getContext("2d");
  if (pen) {
    const gradient = pen.createLinearGradient(0, 0, 0, 64);
    gradient.addColorStop(0, "rgba(255,255,255,0)");
    gradient.addColorStop(1, "rgba(255,255,255,1)");
    pen.fillStyle = gradient;
    pen.fillRect(0, 0, 1, 64);
  }
  return new CanvasTexture(canvas);
}
