/** Prints of the soles on the ground, where feet have come down; the oldest go first. */

import { CircleGeometry, DynamicDrawUsage, InstancedMesh, Matrix4, MeshBasicMaterial, Quaternion, Vector3 } from "three";

const MOST = 240;
const HEIGHT = 0.012;
/** Half the width and half the length of a sole, metres; its middle lies so far before the ankle. */
const SOLE = [0.045, 0.125] as const;
const BEFORE_ANKLE = 0.06;
const UP = new Vector3(0, 1, 0);

export class Footprints {
  readonly mesh: InstancedMesh;
  private readonly material: MeshBasicMaterial;
  private next = 0;

  constructor(color: number) {
    this.material = new MeshBasicMaterial({ color, transparent: true, opacity: 0.42, depthWrite: false, toneMapped: false });
    const sole = new CircleGeometry(1, 20).rotateX(-Math.PI / 2).scale(SOLE[0], 1, SOLE[1]);
    this.mesh = new InstancedMesh(sole, this.material, MOST);
    this.mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 2;
    this.mesh.count = 0;
  }

  get count(): number {
    return this.mesh.count;
  }

  /** A print of the foot whose ankle is above (x, z), metres, turned to `heading`, on the ground at height y. */
  add([x, y, z]: readonly [number, number, number], heading: number): void {
    const middle = new Vector3(x + BEFORE_ANKLE * Math.sin(heading), y + HEIGHT, z + BEFORE_ANKLE * Math.cos(heading));
    const turn = new Quaternion().setFromAxisAngle(UP, heading);
    this.mesh.setMatrixAt(this.next, new Matrix4().compose(middle, turn, new Vector3(1, 1, 1)));
    this.mesh.instanceMatrix.needsUpdate = true;
    this.next = (this.next + 1) % MOST;
    this.mesh.count = Math.min(MOST, Math.max(this.mesh.count, this.next || MOST));
  }

  /** In another colour. */
  paint(color: number): void {
    this.material.color.set(color);
  }

  clear(): void {
    this.mesh.count = this.next = 0;
  }
}
