/** The scene on the stage: floor, boxes, start and gate, kept so that a change of colours can build it anew. */

import { Group } from "three";
import { prepareBox, type OrientedBox, type PreparedBox } from "../camera/spring_arm";
import type { Box, SceneMessage } from "../generated/messages";
import { Gate } from "./gate";
import { Ground } from "./ground";
import { Obstacles } from "./obstacles";
import type { Palette } from "./palette";

export class World {
  readonly group = new Group();
  /** The obstacles for distance queries. */
  boxes: readonly PreparedBox[] = [];
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
    this.repaint(palette, rich);
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

function orientedBox({ center, rotation, size }: Box): OrientedBox {
  return { center, rotation, halfSize: [size[0] / 2, size[1] / 2, size[2] / 2] };
}
