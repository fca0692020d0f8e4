/** Rings on the floor: where the avatar goes, or the place near it that is offered instead. */

import { DoubleSide, Group, Mesh, MeshBasicMaterial, RingGeometry } from "three";

const HEIGHT = 0.016;

export class GoalMarker {
  readonly group = new Group();
  private readonly ring: Mesh<RingGeometry, MeshBasicMaterial>;

  constructor() {
    const material = new MeshBasicMaterial({ transparent: true, depthWrite: false, side: DoubleSide, toneMapped: false });
    this.ring = new Mesh(new RingGeometry(0.13, 0.2, 40), material);
    this.ring.rotation.x = -Math.PI / 2;
    this.ring.renderOrder = 3;
    this.group.add(this.ring);
    this.group.visible = false;
  }

  show(place: readonly [x: number, height: number, z: number], color: number, offered: boolean): void {
    this.group.position.set(place[0], place[1] + HEIGHT, place[2]);
    this.ring.material.color.set(color);
    this.ring.material.opacity = offered ? 0.35 : 0.9;
    this.group.visible = true;
  }

  hide(): void {
    this.group.visible = false;
  }
}
