/** What is no longer shown, kept until what came in its place has been drawn: so the programs that both use stay compiled. */

import { Mesh, type Group, type Material, type Texture } from "three";

export class Leaving {
  private readonly meshes: Mesh[] = [];

  /** Takes everything out of a group. */
  empty(group: Group): void {
    group.traverse((object) => {
      if (object instanceof Mesh) this.meshes.push(object as Mesh);
    });
    group.clear();
  }

  /** Frees what it holds on the graphics card: the picture has been drawn without it. */
  letGo(): void {
    for (const mesh of this.meshes.splice(0)) disposeMesh(mesh);
  }
}

/** Frees a mesh's geometry, materials and their pictures. */
export function disposeMesh({ geometry, material }: Mesh): void {
  geometry.dispose();
  for (const each of Array.isArray(material) ? material : [material]) disposeMaterial(each);
}

function disposeMaterial(material: Material): void {
  for (const value of Object.values(material) as unknown[]) {
    if (typeof value === "object" && value !== null && "isTexture" in value) (value as Texture).dispose();
  }
  material.dispose();
}
