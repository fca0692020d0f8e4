/** The picture in the picture: the avatar from its side, cut open just before it, so that nothing hides the dodge. */

import { PerspectiveCamera } from "three";
import { dampAngle } from "./damping";
import { backwards } from "./roomier_view";
import { pointAlong } from "./spring_arm";
import type { Followed } from "./third_person";
import { VIEWS } from "./views";

const FIELD_OF_VIEW = 36;
const DISTANCE = 3.8;
/** What is nearer to the viewer than so far before the avatar is left out. */
const BEFORE = 0.65;
const MIDDLE = 0.58;

export class InsetCamera {
  readonly camera = new PerspectiveCamera(FIELD_OF_VIEW, 4 / 3, DISTANCE - BEFORE, 60);
  private heading = NaN;

  /** Comes along with the avatar; `aspect` is the picture's width by its height. */
  update({ x, z, heading, eye, ground }: Followed, aspect: number, dt: number): void {
    this.heading = Number.isNaN(this.heading) ? heading : dampAngle(this.heading, heading, VIEWS.side.halflife, dt);
    const middle = [x, ground + (eye - ground) * MIDDLE, z] as const;
    const { camera } = this;
    camera.position.set(...pointAlong(middle, backwards(this.heading + (VIEWS.side.bearing ?? 0), 0.06), DISTANCE));
    camera.lookAt(...middle);
    camera.aspect = aspect;
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
  }
}
