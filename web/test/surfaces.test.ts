import { BoxGeometry, Mesh, MeshLambertMaterial } from "three";
import { describe, expect, it } from "vitest";
import { distanceToBoxes, isWall, prepareBox } from "../src/camera/spring_arm";
import { ThirdPersonCamera } from "../src/camera/third_person";
import { Surfaces } from "../src/stage/surfaces";

/** A plate of 10 cm, 10 by 10 m, whose middle is so high. */
function storey(y: number): Mesh {
  const plate = new Mesh(new BoxGeometry(10, 0.1, 10), new MeshLambertMaterial());
  plate.position.y = y;
  plate.updateMatrixWorld();
  return plate;
}

const house = prepareBox({ center: [0, 3, 0], rotation: [0, 0, 0, 1], halfSize: [5, 3, 5], hollow: true });

describe("a place that is told by its triangles", () => {
  it("keeps nobody off the room in it", () => {
    expect(isWall(house)).toBe(false);
    expect(distanceToBoxes([house], 0, 1.5, 0)).toBe(Infinity);
  });

  it("holds the line of sight up, but not where the storey above is", () => {
    const surfaces = new Surfaces();
    surfaces.take([storey(0), storey(3)]);
    expect(surfaces.sight([0, 1.5, 0], [0, 1, 0], 9)).toBeCloseTo(1.45, 6);
    expect(surfaces.sight([0, 1.5, 0], [1, 0, 0], 9)).toBe(9);
    surfaces.lookUp(0, 0, 0);
    expect(surfaces.sight([0, 1.5, 0], [0, 1, 0], 9)).toBe(9);
    surfaces.open([0, 5, 0]);
    expect(surfaces.drawnUpTo).toBeCloseTo(2.8, 6);
    surfaces.open([0, 1, 0]);
    expect(surfaces.drawnUpTo).toBeGreaterThan(1000);
  });

  it("is seen from within: the camera stays as far behind who is upstairs as in the open", () => {
    const surfaces = new Surfaces(), camera = new ThirdPersonCamera(() => false);
    surfaces.take([storey(0), storey(3), storey(6)]);
    const upstairs = { x: 0, z: 0, heading: 0, eye: 4.6, ground: 3.05, sideways: 0, trail: false };
    camera.snap(upstairs);
    surfaces.lookUp(0, upstairs.ground, 0);
    for (let t = 0; t < 2; t += 1 / 30) camera.update(upstairs, { all: [house], walls: [house].filter((box) => isWall(box)), sight: surfaces.sight }, 1 / 30);
    const [x, y, z] = camera.position;
    expect(Math.hypot(x, z)).toBeGreaterThan(2.5);
    expect(y).toBeGreaterThan(3.1);
  });

  it("is seen from aside where a post stands close behind, with two rays in a picture and one for the arm", () => {
    const post = new Mesh(new BoxGeometry(0.3, 4, 0.3), new MeshLambertMaterial());
    post.position.set(0, 2, -0.6);
    post.updateMatrixWorld();
    const surfaces = new Surfaces(), camera = new ThirdPersonCamera(() => false);
    surfaces.take([storey(0), post]);
    const here = { x: 0, z: 0, heading: 0, eye: 1.6, ground: 0.05, sideways: 0, trail: false };
    camera.snap(here);
    let rays = 0;
    const sight: typeof surfaces.sight = (...asked) => {
      rays++;
      return surfaces.sight(...asked);
    };
    const frames = 90;
    for (let frame = 0; frame < frames; frame++) camera.update(here, { all: [house], walls: [], sight }, 1 / 30);
    const [x, , z] = camera.position;
    expect(Math.hypot(x, z)).toBeGreaterThan(2);
    expect(camera.avatarOpacity).toBe(1);
    expect(rays).toBeLessThanOrEqual(3 * frames);
    const before = camera.position;
    for (let frame = 0; frame < frames; frame++) camera.update(here, { all: [house], walls: [], sight }, 1 / 30);
    expect(Math.hypot(...camera.position.map((value, i) => value - (before[i] ?? 0)))).toBeLessThan(0.05);
  });
});
