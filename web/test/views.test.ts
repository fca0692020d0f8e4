import { describe, expect, it } from "vitest";
import { InsetCamera } from "../src/camera/inset";
import { ThirdPersonCamera, type Followed } from "../src/camera/third_person";
import { nextView, VIEW_NAMES, viewNamed, VIEWS, type ViewName } from "../src/camera/views";

const OPEN = { all: [], walls: [] };
const standing: Followed = { x: 3, z: -2, heading: 0.7, eye: 1.55, ground: 0, sideways: 0, trail: false };

function seconds(camera: ThirdPersonCamera, followed: Followed, time: number): void {
  for (let t = 0; t < time; t += 1 / 60) camera.update(followed, OPEN, 1 / 60);
}

/** Where the camera is, as the avatar would say: so far ahead, so far to the left, so high. */
function seenFromAvatar(camera: ThirdPersonCamera, { x, z, heading }: Followed): [number, number, number] {
  const [dx, dz] = [camera.position[0] - x, camera.position[2] - z];
  return [dx * Math.sin(heading) + dz * Math.cos(heading), dx * Math.cos(heading) - dz * Math.sin(heading), camera.position[1]];
}

function showing(name: ViewName, followed = standing): ThirdPersonCamera {
  const camera = new ThirdPersonCamera(() => false);
  camera.snap(followed);
  camera.show(name);
  seconds(camera, followed, 4);
  return camera;
}

describe("the cameras", () => {
  it("stand where their names say", () => {
    const place = (name: ViewName) => seenFromAvatar(showing(name), standing);
    const [behind, side, front, above, shoulder] = (["behind", "side", "front", "above", "shoulder"] as const).map(place);
    expect(behind?.[0]).toBeLessThan(-3);
    expect(side?.[1]).toBeLessThan(-3);
    expect(Math.abs(side?.[0] ?? NaN)).toBeLessThan(0.1);
    expect(front?.[0]).toBeGreaterThan(3);
    expect(above?.[2]).toBeGreaterThan(6);
    expect(shoulder?.[0]).toBeGreaterThan(-2);
    expect(shoulder?.[1]).toBeCloseTo(-VIEWS.shoulder.aside, 1);
  });

  it("stay there while one walks and turns, and the free one keeps its direction", () => {
    for (const name of VIEW_NAMES) {
      const camera = showing(name);
      const before = camera.heading;
      const turned = { ...standing, x: 8, z: 5, heading: 2.4 };
      seconds(camera, turned, 5);
      const expected = name === "orbit" || name === "behind" ? before : before + 1.7;
      expect(Math.cos(camera.heading - expected)).toBeGreaterThan(0.999);
      expect(Math.hypot(camera.target[0] - 8, camera.target[2] - 5)).toBeLessThan(0.5);
    }
  });

  it("go over into each other without a jump", () => {
    const camera = showing("behind");
    for (const name of [...VIEW_NAMES, ...[...VIEW_NAMES].reverse()]) {
      camera.show(name);
      for (let frame = 0; frame < 40; frame++) {
        const before = camera.position;
        camera.update(standing, OPEN, 1 / 60);
        expect(Math.hypot(...camera.position.map((v, i) => v - (before[i] ?? 0)))).toBeLessThan(1.5);
      }
    }
  });

  it("are found as they were left, and come back to their place when asked", () => {
    const camera = showing("side");
    camera.turn(0.5, 0.2);
    camera.zoom(0.7);
    seconds(camera, standing, 2);
    const left = camera.position;
    camera.show("above");
    seconds(camera, standing, 2);
    camera.show("side");
    seconds(camera, standing, 4);
    camera.position.forEach((v, i) => expect(v).toBeCloseTo(left[i] ?? NaN, 2));
    camera.recenter();
    seconds(camera, standing, 3);
    expect(camera.heading).toBeCloseTo(standing.heading + Math.PI / 2, 1);
  });

  it("follow one another round and round, and unknown names mean the first", () => {
    let name: ViewName = "behind";
    for (let i = 0; i < VIEW_NAMES.length; i++) name = nextView(name);
    expect([name, viewNamed("front"), viewNamed("nope"), viewNamed(null)]).toEqual(["behind", "front", "behind", "behind"]);
  });

  it("show the side view in the corner cut open just before the avatar", () => {
    const inset = new InsetCamera();
    inset.update(standing, 1.5, 1 / 60);
    const distance = Math.hypot(inset.camera.position.x - standing.x, inset.camera.position.z - standing.z);
    expect(distance - inset.camera.near).toBeGreaterThan(0.5);
    expect(distance - inset.camera.near).toBeLessThan(0.8);
  });
});
