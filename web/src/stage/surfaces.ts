/** What is told by its triangles and not as a solid body: how far one sees past it, and the storey above that is cut away. */

import { Mesh, Plane, Raycaster, Vector3, type Material, type Object3D } from "three";
import type { Vec3 } from "../camera/vectors";

/** With more triangles the camera does not mind them: looking for the nearest would take too long in every frame. */
const MOST_LOOKED_AT = 400_000;
/** Metres above the floor: what begins lower is no storey above. */
const HEADROOM = 2.2;
/** Metres above the floor up to which a storey above is looked for. */
const HIGHEST = 12;
/** Metres below a ceiling from which on it is cut away. */
const BELOW = 0.15;
const UNCUT = 1e6;

export class Surfaces {
  private readonly ray = new Raycaster();
  /** What lies above is not drawn. */
  private readonly cut = new Plane(new Vector3(0, -1, 0), UNCUT);
  /** From this height on it is the storey above, over the head of who is shown. */
  private above = Infinity;
  private shown: readonly Object3D[] = [];
  private triangles = 0;

  /** Takes these objects, with what hangs on them, in place of those before. */
  take(objects: readonly Object3D[]): void {
    this.shown = objects;
    this.triangles = 0;
    for (const object of objects) object.traverse((each) => this.prepare(each));
  }

  /** Whether there are none. */
  get empty(): boolean {
    return this.shown.length === 0;
  }

  /** The height from which on nothing is drawn. */
  get drawnUpTo(): number {
    return this.cut.constant;
  }

  /** How far one sees from a point along a unit vector, at most `reach` metres. */
  readonly sight = (from: Vec3, direction: Vec3, reach: number): number => {
    if (!this.lookedAt) return reach;
    this.ray.set(new Vector3(...from), new Vector3(...direction));
    this.ray.far = reach;
    return this.ray.intersectObjects([...this.shown]).find(({ point }) => point.y < this.above)?.distance ?? reach;
  };

  /** Finds the storey above a place on a floor: the camera may be in it, and it is cut away then. */
  lookUp(x: number, floor: number, z: number): void {
    this.above = Infinity;
    if (!this.lookedAt) return;
    this.ray.set(new Vector3(x, floor + HEADROOM, z), new Vector3(0, 1, 0));
    this.ray.far = HIGHEST;
    const ceiling = this.ray.intersectObjects([...this.shown])[0];
    if (ceiling) this.above = ceiling.point.y - BELOW;
  }

  /** Cuts the storey above away for a camera that is in it. */
  open(camera: Vec3): void {
    this.cut.constant = camera[1] > this.above ? this.above : UNCUT;
  }

  private get lookedAt(): boolean {
    return this.triangles > 0 && this.triangles <= MOST_LOOKED_AT;
  }

  private prepare(object: Object3D): void {
    if (!(object instanceof Mesh)) return;
    const { geometry, material } = object as Mesh;
    for (const each of [material].flat() as Material[]) each.clippingPlanes = [this.cut];
    this.triangles += (geometry.index?.count ?? geometry.attributes["position"]?.count ?? 0) / 3;
  }
}
