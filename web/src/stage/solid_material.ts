/** What solid things of a scene are made of. */

import { MeshLambertMaterial, MeshStandardMaterial } from "three";

export type SolidMaterial = MeshStandardMaterial | MeshLambertMaterial;

/** A matt surface, physically based where it may be `rich`. */
export function solidMaterial(color: number, roughness: number, rich: boolean): SolidMaterial {
  return rich ? new MeshStandardMaterial({ color, roughness }) : new MeshLambertMaterial({ color });
}
