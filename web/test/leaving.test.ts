import { BoxGeometry, Group, Mesh, MeshBasicMaterial, Texture } from "three";
import { expect, test } from "vitest";
import { Leaving } from "../src/stage/leaving";

test("what leaves is freed once the next picture has been drawn, not before, and all that it holds", () => {
  const freed: string[] = [];
  const map = new Texture(), material = new MeshBasicMaterial({ map }), geometry = new BoxGeometry();
  Object.entries({ map, material, geometry }).forEach(([name, thing]) => thing.addEventListener("dispose", () => freed.push(name)));
  const group = new Group(), inner = new Group();
  inner.add(new Mesh(geometry, material));
  group.add(inner);
  const leaving = new Leaving();
  leaving.empty(group);
  expect(group.children).toEqual([]);
  expect(freed).toEqual([]);
  leaving.letGo();
  expect(freed.sort()).toEqual(["geometry", "map", "material"]);
  leaving.letGo();
  expect(freed.length).toBe(3);
});
