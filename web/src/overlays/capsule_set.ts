/** Many capsules in few draw calls: three instanced parts (a tube and two half spheres), placed by their end points. */

import {
  CylinderGeometry, DynamicDrawUsage, Group, InstancedMesh, Matrix4, MeshBasicMaterial, MeshLambertMaterial,
  Quaternion, SphereGeometry, Vector3, type Material,
} from "three";

const UP = new Vector3(0, 1, 0);

export interface CapsuleLook {
  readonly color: number;
  readonly opacity: number;
  /** Shaded like a body instead of flat like a mark. */
  readonly solid?: boolean;
  /** Drawn over everything. */
  readonly onTop?: boolean;
}

export class CapsuleSet {
  readonly group = new Group();
  private readonly tubes: InstancedMesh;
  private readonly tops: InstancedMesh;
  private readonly bottoms: InstancedMesh;
  private readonly material: MeshBasicMaterial | MeshLambertMaterial;
  private readonly start = new Vector3();
  private readonly end = new Vector3();
  private readonly middle = new Vector3();
  private readonly axis = new Vector3();
  private readonly size = new Vector3();
  private readonly turn = new Quaternion();
  private readonly matrix = new Matrix4();

  /** @param capacity the most capsules at once */
  constructor(private readonly capacity: number, look: CapsuleLook) {
    const options = {
      color: look.color, transparent: look.opacity < 1, opacity: look.opacity, depthWrite: look.opacity === 1,
      depthTest: !look.onTop,
    };
    this.material = look.solid ? new MeshLambertMaterial(options) : new MeshBasicMaterial({ ...options, toneMapped: false });
    this.tubes = instanced(new CylinderGeometry(1, 1, 1, 14, 1, true), this.material, capacity);
    this.tops = instanced(halfSphere(0), this.material, capacity);
    this.bottoms = instanced(halfSphere(Math.PI / 2), this.material, capacity);
    this.group.renderOrder = look.onTop ? 6 : 4;
    for (const part of this.parts) part.castShadow = look.solid === true;
    this.group.add(...this.parts);
  }

  setColor(color: number): void {
    this.material.color.set(color);
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
