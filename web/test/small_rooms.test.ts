import { describe, expect, it } from "vitest";
import { distanceToBoxes, isWall, pointAlong, prepareBox, type CameraObstacles, type OrientedBox } from "../src/camera/spring_arm";
import { ThirdPersonCamera, type Followed } from "../src/camera/third_person";
import { VIEW_NAMES, type ViewName } from "../src/camera/views";

const THICK = 0.1;

function wall(center: OrientedBox["center"], halfSize: OrientedBox["halfSize"]): OrientedBox {
  return { center, rotation: [0, 0, 0, 1], halfSize };
}

/** Four walls of a room about the origin, so wide, deep and high inside. */
function room(wide: number, deep: number, high: number): CameraObstacles {
  const [x, z, y] = [wide / 2 + THICK / 2, deep / 2 + THICK / 2, high / 2];
  const boxes = [
    wall([-x, y, 0], [THICK / 2, y, deep / 2]), wall([x, y, 0], [THICK / 2, y, deep / 2]),
    wall([0, y, -z], [wide / 2, y, THICK / 2]), wall([0, y, z], [wide / 2, y, THICK / 2]),
  ].map(prepareBox);
  return { all: boxes, walls: boxes.filter((box) => isWall(box)) };
}

function standing(x: number, z: number, heading: number): Followed {
  return { x, z, heading, eye: 1.55, ground: 0, sideways: 0, trail: false };
}

/** Two walls across the way at z = 0, with a gap of 40 cm between them, and a lintel. */
function doorway(): CameraObstacles {
  const walls = [wall([2.2, 1.1, 0], [2, 1.1, THICK]), wall([-2.2, 1.1, 0], [2, 1.1, THICK])].map(prepareBox);
  return { all: [...walls, prepareBox(wall([0, 2.35, 0], [4.2, 0.15, THICK]))], walls };
}

describe("in a doorway that is narrower than the shoulders", () => {
  it("the avatar is seen all the way through, from behind", () => {
    const obstacles = doorway(), camera = new ThirdPersonCamera(() => false);
    camera.snap(standing(0, -2, 0));
    for (let z = -2; z < 1.5; z += 0.01) {
      camera.update(standing(0.04 * Math.sin(6 * z), z, 0), obstacles, 1 / 60);
      expect(camera.avatarOpacity, `at ${z.toFixed(2)}`).toBe(1);
      expect(distanceToBoxes(obstacles.all, ...camera.position)).toBeGreaterThan(0.1);
    }
  });
});

function shown(name: ViewName, obstacles: CameraObstacles, followed: Followed): ThirdPersonCamera {
  const camera = new ThirdPersonCamera(() => false);
  camera.snap(followed);
  camera.show(name);
  for (let t = 0; t < 3; t += 1 / 30) {
    camera.update(followed, obstacles, 1 / 30);
    const all = [0, 0.25, 0.5, 0.75, 1].map((share) => pointBetween(camera, share));
    for (const point of all) expect(distanceToBoxes(obstacles.walls, ...point)).toBeGreaterThan(0.1);
  }
  return camera;
}

function pointBetween({ target, position }: ThirdPersonCamera, share: number): [number, number, number] {
  const way = position.map((at, i) => at - (target[i] ?? 0)) as [number, number, number];
  return pointAlong(target, way, share);
}

describe("in small rooms", () => {
  for (const name of VIEW_NAMES) {
    it(`the camera ${name} looks neither through a wall nor from inside one`, () => {
      const small = room(2.4, 2.4, 2.2);
      expect(small.walls.length).toBe(4);
      for (const [x, z] of [[0, 0], [0.8, 0], [0.75, -0.75], [-0.2, 0.8]] as const) {
        for (let k = 0; k < 8; k++) shown(name, small, standing(x, z, (k * Math.PI) / 4 + 0.1));
      }
    });
  }

  it("the side camera comes round in a narrow corridor until one sees the body", () => {
    for (const wide of [0.9, 1.2, 1.6]) {
      const { target, position } = shown("side", room(wide, 20, 2.4), standing(0, 0, 0));
      expect(Math.hypot(...position.map((at, i) => at - (target[i] ?? 0)))).toBeGreaterThan(1.2);
    }
  });
});
