/** The scene on the stage: floor, boxes, start and gate, kept so that a change of colours can build it anew. */

import { Group } from "three";
import { isWall, prepareBox, type CameraObstacles, type OrientedBox, type PreparedBox, type Vec3 } from "../camera/spring_arm";
import type { Box, SceneMessage } from "../generated/messages";
import { Gate } from "./gate";
import { Ground } from "./ground";
import { Obstacles } from "./obstacles";
import { nearestOnSegment } from "../overlays/touching";
import type { Palette } from "./palette";

const SIGHT_RADIUS = 0.06;
const BESIDE_THE_BODY = 0.97;

export class World {
  readonly group = new Group();
  /** The obstacles for distance queries. */
  boxes: readonly PreparedBox[] = [];
  cameraObstacles: CameraObstacles = { all: [], walls: [] };
  message: SceneMessage | null = null;
  readonly gate = new Gate();
  private readonly ground = new Ground();
  private readonly obstacles = new Obstacles();

  constructor() {
    this.group.add(this.ground.group, this.obstacles.group, this.gate.group);
  }

  show(message: SceneMessage, palette: Palette, rich: boolean): void {
    this.message = message;
    this.boxes = message.boxes.map((box) => prepareBox(orientedBox(box)));
    this.cameraObstacles = { all: this.boxes, walls: this.boxes.filter((box) => isWall(box)) };
    this.repaint(palette, rich);
  }

  /** Lets the boxes of these names glow: they close the way. */
  markBlocking(names: readonly string[]): void {
    const wanted = new Set(names);
    const numbers = (this.message?.boxes ?? []).flatMap((box, i) => (wanted.has(box.name) ? [i] : []));
    this.obstacles.mark(new Set(numbers));
  }

  /** Makes boxes see-through that stand between the camera and the avatar. */
  clearSight(camera: Vec3, body: readonly Vec3[], dt: number): void {
    this.obstacles.fade((i) => hides(this.boxes[i], camera, body), dt);
  }

  /** Builds everything again in other colours or other materials. */
  repaint(palette: Palette, rich: boolean): void {
    const { message } = this;
    if (!message) return;
    const { ground, start, finish } = message;
    this.obstacles.build(message.boxes.map(orientedBox), palette, rich);
    this.ground.lay(ground.size[0], ground.size[1], ground.center, this.boxes, palette, rich);
    const gate = finish && { position: [finish.x, finish.z] as const, heading: finish.heading, width: finish.width };
    this.gate.build(gate, [start.x, start.z], palette);
  }
}

/** Whether the box crosses a line of sight, apart from what stands beside the body itself. */
function hides(box: PreparedBox | undefined, camera: Vec3, body: readonly Vec3[]): boolean {
  return box !== undefined && body.some((point) => {
    const { share, distance } = nearestOnSegment(box, [...camera, ...point], 0);
    return distance < SIGHT_RADIUS && share < BESIDE_THE_BODY;
  });
}

function orientedBox({ center, rotation, size }: Box): OrientedBox {
  return { center, rotation, halfSize: [size[0] / 2, size[1] / 2, size[2] / 2] };
}
