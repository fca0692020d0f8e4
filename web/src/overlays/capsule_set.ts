/** Many capsules in few draw calls: three instanced parts (a tube and two half spheres), placed by their end points. */

import {
  CylinderGeometry, DynamicDrawUsage, Group, InstancedBufferAttribute, InstancedMesh, Matrix4, MeshLambertMaterial, Quaternion,
  SphereGeometry, Vector3, type Material,
} from "three";
import { MarkMaterial, type MarkLook } from "./capsule_material";

const UP = new Vector3(0, 1, 0);

/** A mark that one sees through, or a solid body of some colour. */
export type CapsuleLook = MarkLook | { readonly solid: number };

export class CapsuleSet {
  readonly group = new Group();
  private readonly tubes: InstancedMesh;
  private readonly tops: InstancedMesh;
  private readonly bottoms: InstancedMesh;
  private readonly material: MarkMaterial | MeshLambertMaterial;
  private readonly shares: InstancedBufferAttribute;
  private readonly start = new Vector3();
  private readonly end = new Vector3();
  private readonly middle = new Vector3();
  private readonly axis = new Vector3();
  private readonly size = new Vector3();
  private readonly turn = new Quaternion();
  private readonly matrix = new Matrix4();

  /** @param capacity the most capsules at once */
  constructor(private readonly capacity: number, look: CapsuleLook) {
    const solid = "solid" in look;
    this.material = solid ? new MeshLambertMaterial({ color: look.solid }) : new MarkMaterial(look);
    this.shares = new InstancedBufferAttribute(new Float32Array(capacity).fill(1), 1);
    this.tubes = instanced(new CylinderGeometry(1, 1, 1, 14, 1, true), this.material, capacity);
    this.tops = instanced(halfSphere(0), this.material, capacity);
    this.bottoms = instanced(halfSphere(Math.PI / 2), this.material, capacity);
    this.group.renderOrder = !solid && look.onTop ? 6 : 4;
    this.group.visible = false;
    for (const part of this.parts) {
      part.castShadow = solid;
      part.geometry.setAttribute("share", this.shares);
    }
    this.group.add(...this.parts);
  }

  /** Says how far the avatar is from the viewer, metres: ghosts give way in front of it. */
  setAvatarDepth(metres: number): void {
    if (this.material instanceof MarkMaterial) this.material.setAvatarDepth(metres);
  }

  /** Gives each capsule, in the order of `place`, a share of the opacity of ghosts. */
  setShares(share: (i: number) => number): void {
    for (let i = 0; i < this.capacity; i++) this.shares.setX(i, share(i));
    this.shares.needsUpdate = true;
  }

  /**
   * Places the capsules; those beyond the capacity are left out.
   *
   * @param segments ax, ay, az, bx, by, bz of each, metres
   * @param radius the radius of capsule `i`
   * @param shown which capsules to draw; all if left out
   */
  place(segments: ArrayLike<number>, radius: (i: number) => number, shown?: (i: number) => boolean): void {
    let count = 0;
    for (let i = 0; i < segments.length / 6 && count < this.capacity; i++) {
      if (shown && !shown(i)) continue;
      this.placeOne(count, segments, 6 * i, radius(i));
      count++;
    }
    this.group.visible = count > 0;
    for (const part of this.parts) {
      part.count = count;
      part.instanceMatrix.needsUpdate = true;
    }
  }

  clear(): void {
    this.place([], () => 0);
  }

  dispose(): void {
    this.group.removeFromParent();
    for (const part of this.parts) {
      part.geometry.dispose();
      part.dispose();
    }
    this.material.dispose();
  }

  private get parts(): readonly InstancedMesh[] {
    return [this.tubes, this.tops, this.bottoms];
  }

  private placeOne(slot: number, segments: ArrayLike<number>, at: number, radius: number): void {
    this.start.set(segments[at] ?? 0, segments[at + 1] ?? 0, segments[at + 2] ?? 0);
    this.end.set(segments[at + 3] ?? 0, segments[at + 4] ?? 0, segments[at + 5] ?? 0);
    this.axis.subVectors(this.end, this.start);
    const length = this.axis.length();
    this.turn.setFromUnitVectors(UP, length > 1e-6 ? this.axis.divideScalar(length) : UP);
    this.middle.addVectors(this.start, this.end).multiplyScalar(0.5);
    this.tubes.setMatrixAt(slot, this.matrix.compose(this.middle, this.turn, this.size.set(radius, Math.max(length, 1e-6), radius)));
    this.size.setScalar(radius);
    this.bottoms.setMatrixAt(slot, this.matrix.compose(this.start, this.turn, this.size));
    this.tops.setMatrixAt(slot, this.matrix.compose(this.end, this.turn, this.size));
  }
}

function halfSphere(from: number): SphereGeometry {
  return new SphereGeometry(1, 14, 5, 0, 2 * Math.PI, from, Math.PI / 2);
}

function instanced(geometry: CylinderGeometry | SphereGeometry, material: Material, count: number): InstancedMesh {
  const mesh = new InstancedMesh(geometry, material, count);
  mesh.instanceMatrix.setUsage(DynamicDrawUsage);
  mesh.frustumCulled = false;
  mesh.count = 0;
  return mesh;
}
