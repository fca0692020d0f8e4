/** The model of a place as its file shows it. */

import { Group, Mesh, type Material, type Object3D, type Texture } from "three";
import { asked } from "../net/asked";

export class PlaceModel {
  readonly group = new Group();
  private url: string | null = null;
  private loads = 0;

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
    scene.traverse((object) => (object.castShadow = object.receiveShadow = object instanceof Mesh));
    this.group.add(scene);
  }

  private clear(): void {
    for (const child of [...this.group.children]) dispose(child);
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
