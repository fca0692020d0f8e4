/** Decoders of compressed meshes that a page without a server has with it: Draco's are too large. */

import type { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { MeshoptDecoder } from "three/addons/libs/meshopt_decoder.module.js";

/** Gives the loader what it may need. */
export async function addDecoders(loader: GLTFLoader, file: ArrayBuffer): Promise<void> {
  void file;
  await MeshoptDecoder.ready;
  loader.setMeshoptDecoder(MeshoptDecoder);
}
