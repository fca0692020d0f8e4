/** Decoders of compressed meshes; each is fetched from our own server when a file first needs it. */

import type { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

const JSON_CHUNK = 20;

/** Gives the loader what this file needs. */
export async function addDecoders(loader: GLTFLoader, file: ArrayBuffer): Promise<void> {
  const json = jsonOf(file);
  if (json.includes('meshopt_compression"')) {
    const { MeshoptDecoder } = await import("three/addons/libs/meshopt_decoder.module.js");
    await MeshoptDecoder.ready;
    loader.setMeshoptDecoder(MeshoptDecoder);
  }
  if (json.includes('"KHR_draco_mesh_compression"')) {
    const { DRACOLoader, DRACO_GLTF_CONFIG } = await import("three/addons/loaders/DRACOLoader.js");
    loader.setDRACOLoader(new DRACOLoader().setDecoderPath(DRACO_GLTF_CONFIG).setWorkerLimit(1));
  }
}

/** The JSON text of a GLB, for a look at the names in it. */
function jsonOf(file: ArrayBuffer): string {
  if (file.byteLength < JSON_CHUNK) return "";
  const length = new DataView(file).getUint32(12, true);
  return new TextDecoder().decode(new Uint8Array(file, JSON_CHUNK, Math.min(length, file.byteLength - JSON_CHUNK)));
}
