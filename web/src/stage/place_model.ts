/** The model of a place as its file shows it. */

import { Group, Mesh } from "three";
import { asked } from "../net/asked";
import { disposeMesh, type Leaving } from "./leaving";

export class PlaceModel {
  readonly group = new Group();
  private url: string | null = null;
  private loads = 0;

  constructor(private readonly leaving: Leaving) {}

  /** Shows the model of this address, none for null; the newest call wins. @throws Error when it cannot be shown */
  async show(url: string | null): Promise<void> {
    if (url === this.url) return;
    const load = ++this.loads;
    this.url = url;
    this.leaving.empty(this.group);
    if (url === null) return;
    const file = await (await asked(new URL(url, document.baseURI).href)).arrayBuffer();
    const { GLTFLoader } = await import("three/addons/loaders/GLTFLoader.js");
    const { addDecoders } = await import("../avatar/decoders");
    const loader = new GLTFLoader();
    await addDecoders(loader, file);
    const { scene } = await loader.parseAsync(file, "").finally(() => loader.dracoLoader?.dispose());
    if (load !== this.loads) {
      scene.traverse((object) => object instanceof Mesh && disposeMesh(object as Mesh));
      return;
    }
    scene.updateMatrixWorld(true);
    scene.traverse((object) => (object.castShadow = object.receiveShadow = object instanceof Mesh));
    this.group.add(scene);
  }
}
