import { Mesh, MeshBasicMaterial, MeshLambertMaterial, Raycaster, Vector3 } from "three";
import { beforeEach, describe, expect, it, vi } from "vitest";
import type { SceneMessage } from "../src/generated/messages";
import { HAZE } from "../src/stage/field";
import { PALETTES } from "../src/stage/palette";
import { World } from "../src/stage/world";

const DOORWAY: SceneMessage = {
  type: "scene", name: "doorway", title: "", description: "", ground: { size: [10, 12], center: [0, 2] }, model: null,
  obstacles: [], pushable: [], moving: [], start: { x: 0, z: 0, heading: 0 },
  finish: { x: 0, z: 4.4, heading: 0, width: 3 }, tour: [],
};

/** A canvas that remembers in which colours areas were filled and lines drawn. */
class Canvas {
  width = 0;
  height = 0;
  readonly filled = new Set<unknown>();
  readonly drawn = new Set<unknown>();

  getContext(): unknown {
    const { filled, drawn } = this;
    const pen = {
      fillStyle: "", strokeStyle: "",
      fillRect: () => filled.add(pen.fillStyle), fill: () => filled.add(pen.fillStyle), stroke: () => drawn.add(pen.strokeStyle),
      createLinearGradient: () => ({ addColorStop: () => undefined }), createPattern: () => null,
    };
    return new Proxy(pen, { get: (own, name) => Reflect.get(own, name) ?? (() => undefined) });
  }
}

beforeEach(() => vi.stubGlobal("document", { createElement: () => new Canvas() }));

/** What lies topmost under a point. */
function floorAt(world: World, x: number, z: number): Mesh<never, MeshBasicMaterial | MeshLambertMaterial> | undefined {
  world.group.updateMatrixWorld(true);
  const down = new Raycaster(new Vector3(x, 1, z), new Vector3(0, -1, 0));
  return down.intersectObject(world.group)[0]?.object as ReturnType<typeof floorAt>;
}

describe.each([["cheap", false], ["rich", true]])("the ground, %s", (_, rich) => {
  it.each([4.4, 8, 11, 40, 4000])("goes on past the finish, as far as one sees from z = %d", (z) => {
    const world = new World(), { field, gridFine, gridBold } = PALETTES.light;
    world.show(DOORWAY, PALETTES.light, rich);
    world.follow(0, z);
    for (let turn = 0; turn < 2 * Math.PI; turn += 0.3) {
      for (const far of [6, HAZE[0], HAZE[1]]) {
        const [x, ahead] = [far * Math.sin(turn), z + far * Math.cos(turn)];
        const floor = floorAt(world, x, ahead);
        expect(floor?.material.map, `${x}, ${ahead}`).toBeTruthy();
        if (Math.abs(x) < 5.1 && ahead < 11) continue; // the scene's own slab, and the carpet behind the gate
        const { filled, drawn } = floor?.material.map?.image as Canvas;
        expect([...filled]).toEqual(expect.arrayContaining([...field]));
        expect([...drawn]).toEqual(expect.arrayContaining([gridFine, gridBold]));
      }
    }
  });
});
