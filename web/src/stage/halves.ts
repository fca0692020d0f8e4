/** Two views of the world beside each other, from the same side of two avatars. */

import { PerspectiveCamera } from "three";
import type { Vec3 } from "../camera/vectors";
import type { Stage } from "./stage";

const FIELD_OF_VIEW = 56;

export class Halves {
  private readonly camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.05, 250);

  constructor(private readonly stage: Stage, private readonly host: HTMLElement) {}

  /** Draws the left (0) or right (1) half as the stage's camera sees it, moved by `shift` metres; on an upright page the upper or lower one. */
  draw(half: 0 | 1, shift: Vec3): void {
    const { clientWidth, clientHeight } = this.host;
    const upright = clientWidth < clientHeight;
    const width = upright ? clientWidth : clientWidth / 2;
    const height = upright ? clientHeight / 2 : clientHeight;
    const { camera } = this;
    camera.position.copy(this.stage.camera.position);
    camera.quaternion.copy(this.stage.camera.quaternion);
    camera.position.set(camera.position.x + shift[0], camera.position.y + shift[1], camera.position.z + shift[2]);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    this.stage.renderInto(camera, { left: upright ? 0 : half * width, top: upright ? half * height : 0, width, height }, true);
  }
}
