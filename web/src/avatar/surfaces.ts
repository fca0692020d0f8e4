/** The avatar's materials: they fade when the camera comes close, and have cheap stand-ins for slow machines. */

import { Mesh, MeshLambertMaterial, MeshStandardMaterial, type Material, type Object3D } from "three";

interface Surface {
  readonly mesh: Mesh;
  readonly original: Material | Material[];
  cheap: Material | Material[] | null;
}

/** How a material was before it faded. */
interface Solidity {
  readonly transparent: boolean;
  readonly opacity: number;
}

export class Surfaces {
  private readonly surfaces: Surface[] = [];
  private readonly solid = new Map<Material, Solidity>();
  private opacity = 1;

  constructor(root: Object3D, rich: boolean) {
    root.traverse((object) => {
      if (object instanceof Mesh) {
        const original = object.material as Material | Material[];
        this.surfaces.push({ mesh: object, original, cheap: null });
      }
    });
    if (!rich) this.setRich(false);
  }

  setRich(rich: boolean): void {
    for (const surface of this.surfaces) {
      surface.cheap ??= mapMaterials(surface.original, cheapStandIn);
      surface.mesh.material = rich ? surface.original : surface.cheap;
    }
    const { opacity } = this;
    this.opacity = NaN;
    this.fade(opacity);
  }

  /** @param opacity 1 is solid, 0 invisible */
  fade(opacity: number): void {
    const rounded = Math.round(opacity * 50) / 50;
    if (rounded === this.opacity) return;
    this.opacity = rounded;
    for (const { mesh } of this.surfaces) {
      for (const material of [mesh.material as Material | Material[]].flat()) this.fadeOne(material, rounded);
    }
  }

  private fadeOne(material: Material, opacity: number): void {
    const before = this.solid.get(material) ?? { transparent: material.transparent, opacity: material.opacity };
    this.solid.set(material, before);
    const transparent = before.transparent || opacity < 1;
    if (material.transparent !== transparent) material.needsUpdate = true;
    material.transparent = transparent;
    material.opacity = before.opacity * opacity;
  }
}

function mapMaterials(materials: Material | Material[], change: (material: Material) => Material): Material | Material[] {
  return Array.isArray(materials) ? materials.map(change) : change(materials);
}

/** A material that looks alike and costs a fraction; what is no physically based material stays. */
function cheapStandIn(material: Material): Material {
  if (!(material instanceof MeshStandardMaterial)) return material;
  const { color, map, emissive, emissiveMap, alphaMap, alphaTest, transparent, opacity, side, vertexColors } = material;
  const cheap = new MeshLambertMaterial({
    color, map, emissive, emissiveMap, alphaMap, alphaTest, transparent, opacity, side, vertexColors,
  });
  cheap.depthWrite = material.depthWrite;
  return cheap;
}
