/** The model of a place as its file shows it, and how far one sees in it. */

import { Group, Mesh, Raycaster, Vector3, type Material, type Object3D, type Texture } from "three";
import type { Vec3 } from "../camera/spring_arm";

/** With more triangles the camera does not mind the model: looking for the nearest would take too long in every frame. */
const MOST_LOOKED_AT = 400_000;

export class PlaceModel {
  readonly group = new Group();
  private url: string | null = null;
  private loads = 0;
  private triangles = 0;
  private readonly ray = new Raycaster();

  /** Shows the model of this address, none for null; the newest call wins. @throws Error when it cannot be shown */
  async show(url: string | null): Promise<void> {
    if (url === this.url) return;
    const load = ++this.loads;
    this.url = url;
    this.clear();
    if (url === null) return;
    const response = await fetch(new URL(url, document.baseURI).href);
    if (!response.ok) throw new Error(`the server does not give its model (status ${response.status})`);
    const file = await response.arrayBuffer();
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
    return this.ray.intersectObject(this.group)[0]?.distance ?? reach;
  };

  private prepare(object: Object3D): void {
    if (!(object instanceof Mesh)) return;
    object.castShadow = object.receiveShadow = true;
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
