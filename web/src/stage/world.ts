/** The scene on the stage: floor, obstacles, start and gate, kept so that a change of colours can build it anew. */

import { Group, type Object3D } from "three";
import { convexBody } from "../camera/convex_body";
import { isWall, prepareBox, type CameraObstacles, type OrientedBox, type PreparedBox } from "../camera/spring_arm";
import type { Vec3 } from "../camera/vectors";
import type { Form, MovingObstacle, Obstacle, SceneMessage } from "../generated/messages";
import { Gate } from "./gate";
import { Ground } from "./ground";
import { Leaving } from "./leaving";
import { NOTHING_LOOSE, type Loose } from "./loose";
import { boxAt } from "./moving";
import { Obstacles, type DrawnObstacle } from "./obstacles";
import { PlaceModel } from "./place_model";
import { Surfaces } from "./surfaces";
import { nearestOnSegment } from "../overlays/touching";
import type { Palette } from "./palette";

const SIGHT_RADIUS = 0.06;
const BESIDE_THE_BODY = 0.97;
/** Metres: so the floor of a place, at height 0 too, is what one sees. */
const BELOW_A_PLACE = -0.02;

export class World {
  readonly group = new Group();
  /** The obstacles for distance queries: those that stand, then those that move, where they were drawn last. */
  boxes: PreparedBox[] = [];
  cameraObstacles: CameraObstacles = { all: [], walls: [] };
  message: SceneMessage | null = null;
  /** What was pushed moves by these tracks. */
  loose: Loose = NOTHING_LOOSE;
  private readonly leaving = new Leaving();
  readonly gate = new Gate(this.leaving);
  private readonly ground = new Ground(this.leaving);
  private readonly obstacles = new Obstacles(this.leaving);
  private readonly place = new PlaceModel(this.leaving);
  /** Of the place: its model, and obstacles that are meshes. */
  private readonly surfaces = new Surfaces();

  constructor() {
    this.group.add(this.ground.group, this.obstacles.group, this.gate.group, this.place.group);
  }

  /** Fetches the model of the place that is shown, if it has one. @throws Error when it cannot be shown */
  async showModel(): Promise<void> {
    await this.place.show(this.message?.model?.url ?? null);
    this.takeSurfaces();
  }

  show(message: SceneMessage, palette: Palette, rich: boolean): void {
    this.message = message;
    this.loose = NOTHING_LOOSE;
    this.boxes = allObstacles(message).map(({ form, box }) => prepareBox(inBox(form, box)));
    const walls = this.boxes.filter((box) => isWall(box));
    this.cameraObstacles = { all: this.boxes, walls, sight: this.surfaces.sight };
    this.ground.group.position.y = this.hasFloors ? BELOW_A_PLACE : 0;
    this.repaint(palette, rich);
  }

  /** What one cannot see through: obstacles and the model. */
  get solid(): Group[] {
    return [this.obstacles.group, this.place.group];
  }

  /** The height from which on a place is not drawn: that of the storey above. */
  get drawnUpTo(): number {
    return this.surfaces.drawnUpTo;
  }

  /** Whether a place is shown, on whose floors one can be at any height. */
  get hasFloors(): boolean {
    return this.message?.model != null || this.boxes.some((box) => box.hollow);
  }

  /** Finds the storey above who stands at a place, so that the camera may be there. */
  lookUp(x: number, floor: number, z: number): void {
    this.surfaces.lookUp(x, floor, z);
  }

  /** Lets the obstacles of these names glow: they close the way. */
  markBlocking(names: readonly string[]): void {
    const wanted = new Set(names);
    const numbers = this.names.flatMap((name, i) => (wanted.has(name) ? [i] : []));
    this.obstacles.mark(new Set(numbers));
  }

  /** The names of all obstacles, in the order of `boxes`. */
  get names(): string[] {
    return this.message ? [...this.message.obstacles, ...this.message.moving].map((one) => one.name) : [];
  }

  /** Puts what moves to where it is at the scene's time. */
  move(time: number): void {
    const { message } = this;
    message?.moving.forEach((track, i) => this.put(message.obstacles.length + i, boxAt(track, time)));
    for (const [number, track] of this.loose) this.put(number, boxAt(track, time));
  }

  /** Lets things stand where they were pushed to from now on; what is no longer among them is where it was. */
  loosen(loose: Loose): void {
    for (const number of this.loose.keys()) {
      const thing = this.message?.obstacles[number];
      if (thing && !loose.has(number)) this.put(number, orientedBox(thing));
    }
    this.loose = loose;
  }

  /** Lets the obstacle glow that is in hand. */
  hold(number: number | null): void {
    this.obstacles.hold(number);
  }

  /** The place of a drawn thing among the obstacles; -1 for what is none. */
  placeOf(object: Object3D): number {
    return this.obstacles.group.children.indexOf(object);
  }

  private put(at: number, box: OrientedBox): void {
    const { body, hollow } = this.boxes[at] ?? {};
    this.obstacles.place(at, box);
    this.boxes[at] = prepareBox({ ...box, ...(body && { body }), ...(hollow && { hollow }) });
  }

  private takeSurfaces(): void {
    const meshes = this.obstacles.group.children.filter((_, i) => this.boxes[i]?.hollow);
    this.surfaces.take([...this.place.group.children, ...meshes]);
  }

  /** Brings the open field along with the avatar. */
  follow(x: number, z: number): void {
    this.ground.follow(x, z);
  }

  /** Makes obstacles see-through that stand between the camera and the avatar. */
  clearSight(camera: Vec3, body: readonly Vec3[], dt: number): void {
    this.surfaces.open(camera);
    this.obstacles.fade((i) => hides(this.boxes[i], camera, body), dt);
  }

  /** The picture has been drawn: what was shown before is needed no more. */
  drawn(): void {
    this.leaving.letGo();
  }

  /** Builds everything again in other colours or other materials. */
  repaint(palette: Palette, rich: boolean): void {
    const { message } = this;
    if (!message) return;
    const { ground, start, finish } = message;
    this.obstacles.build(allObstacles(message), palette, rich);
    this.takeSurfaces();
    const standing = this.boxes.slice(0, message.obstacles.length).filter((box) => !box.hollow);
    this.ground.lay(ground.size[0], ground.size[1], ground.center, standing, palette, rich);
    const gate = finish && { position: [finish.x, finish.z] as const, heading: finish.heading, width: finish.width };
    this.gate.build(gate, [start.x, start.z], palette, rich);
  }
}

/** Whether the box crosses a line of sight, apart from what stands beside the body itself. */
function hides(box: PreparedBox | undefined, camera: Vec3, body: readonly Vec3[]): boolean {
  return box !== undefined && body.some((point) => {
    const { share, distance } = nearestOnSegment(box, [...camera, ...point], 0);
    return distance < SIGHT_RADIUS && share < BESIDE_THE_BODY;
  });
}

/** The obstacles that stand, then those that move, where they begin. */
function allObstacles({ obstacles, moving }: SceneMessage): DrawnObstacle[] {
  const standing = obstacles.map((one: Obstacle) => ({ form: one.form, color: one.color, box: orientedBox(one) }));
  return [...standing, ...moving.map((one: MovingObstacle) => ({ form: one.form, color: one.color, box: boxAt(one, 0) }))];
}

function orientedBox({ center, rotation, form: { size } }: Obstacle): OrientedBox {
  return { center, rotation, halfSize: [size[0] / 2, size[1] / 2, size[2] / 2] };
}

function inBox(form: Form, box: OrientedBox): OrientedBox {
  if (form.shape === "mesh") return { ...box, hollow: true };
  const body = convexBody(form);
  return body ? { ...box, body } : box;
}
