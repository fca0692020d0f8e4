/** The model of a place as its file shows it, and how far one sees in it. */

import { Group, Mesh, Plane, Raycaster, Vector3, type Material, type Object3D, type Texture } from "three";
import type { Vec3 } from "../camera/vectors";
import { asked } from "../net/asked";

/** With more triangles the camera does not mind the model: looking for the nearest would take too long in every frame. */
const MOST_LOOKED_AT = 400_000;

/** Metres above the floor: what begins lower is no storey above. */
const HEADROOM = 2.2;
/** Metres above the floor up to which a storey above is looked for. */
const HIGHEST = 12;
/** Metres below a ceiling from which on it is cut away. */
const BELOW = 0.15;
const UNCUT = 1e6;

export class PlaceModel {
  readonly group = new Group();
  private url: string | null = null;
  private loads = 0;
  private triangles = 0;
  private readonly ray = new Raycaster();
  /** What lies above is not drawn. */
  private readonly cut = new Plane(new Vector3(0, -1, 0), UNCUT);
  /** From this height on it is the storey above, over the head of who is shown. */
  private above = Infinity;

  /** Shows the model of this address, none for null; the newest call wins. @throws Error when it cannot be shown */
  async show(url: string | null): Promise<void> {
    if (url === this.url) return;
    const load = ++this.loads;
    this.url = url;
    this.clear();
    if (url === null) return;
    const file = await (await asked(new URL(url, document.baseURI).href)).arrayBuffer();
    const { GLTFLoader } = await import("three/addons/loaders/GLTFLoader.js");
    const { addDecoders } = await import("../avatar/decoders");
    const loader = new GLTFLoader();
    await addDecoders(loader, file);
    const { scene } = await loader.parseAsync(file, "").finally(() => loader.dracoLoader?.dispose());
    if (load !== this.loads) {
      dispose(scene);
      return;
    }
    scene.updateMatrixWorld(true);
    scene.traverse((object) => this.prepare(object));
    this.group.add(scene);
  }

  /** How far one sees from a point along a unit vector, at most `reach` metres. */
  readonly sight = (from: Vec3, direction: Vec3, reach: number): number => {
    if (this.triangles === 0 || this.triangles > MOST_LOOKED_AT) return reach;
    this.ray.set(new Vector3(...from), new Vector3(...direction));
    this.ray.far = reach;
    return this.ray.intersectObject(this.group).find(({ point }) => point.y < this.above)?.distance ?? reach;
  };

  /** Finds the storey above a place on a floor: the camera may be in it, and it is cut away then. */
  lookUp(x: number, floor: number, z: number): void {
    this.above = Infinity;
    if (this.triangles === 0 || this.triangles > MOST_LOOKED_AT) return;
    this.ray.set(new Vector3(x, floor + HEADROOM, z), new Vector3(0, 1, 0));
    this.ray.far = HIGHEST;
    const ceiling = this.ray.intersectObject(this.group)[0];
    if (ceiling) this.above = ceiling.point.y - BELOW;
  }

  /** Cuts the storey above away for a camera that is in it. */
  open(camera: Vec3): void {
    this.cut.constant = camera[1] > this.above ? this.above : UNCUT;
  }

  /** The height from which on nothing is drawn. */
  get drawnUpTo(): number {
    return this.cut.constant;
  }

  private prepare(object: Object3D): void {
    if (!(object instanceof Mesh)) return;
    object.castShadow = object.receiveShadow = true;
    const { material } = object as Mesh;
    for (const each of Array.isArray(material) ? material : [material]) each.clippingPlanes = [this.cut];
    const { index, attributes } = (object as Mesh).geometry;
    this.triangles += (index?.count ?? attributes["position"]?.count ?? 0) / 3;
  }

  private clear(): void {
    for (const child of [...this.group.children]) dispose(child);
    this.triangles = 0;
  }
}

/** Takes it away and frees what it holds on the graphics card. */
function dispose(root: Object3D): void {
  root.removeFromParent();
  root.traverse((object) => {
    if (!(object instanceof Mesh)) return;
    const { geometry, material } = object as Mesh;
    geometry.dispose();
    for (const each of Array.isArray(material) ? material : [material]) disposeMaterial(each);
  });
}

function disposeMaterial(material: Material): void {
  for (const value of Object.values(material) as unknown[]) {
    if (typeof value === "object" && value !== null && "isTexture" in value) (value as Texture).dispose();
  }
  material.dispose();
}
