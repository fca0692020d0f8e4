/** A mouse or a finger on an obstacle: while it is held down, the thing follows over the ground. */

import { Plane, Raycaster, Vector2, Vector3, type Object3D } from "three";
import type { Picture } from "../picture";
import type { Hand } from "./hand";

const UP = new Vector3(0, 1, 0);

export interface GripHost {
  readonly picture: Picture;
  /** Whether one walks now: not while a run is replayed. */
  walks(): boolean;
  /** Whether an obstacle can be pushed, by its number. */
  canBePushed(number: number): boolean;
}

export class Grip {
  private pointer: number | null = null;
  private readonly plane = new Plane(UP.clone(), 0);
  private readonly offset = new Vector2();

  constructor(private readonly view: HTMLElement, private readonly host: GripHost, private readonly hand: Hand) {
    view.addEventListener("pointermove", (event) => {
      if (event.pointerType === "mouse" && event.buttons === 0) this.view.classList.toggle("graspable", this.found(event) !== null);
    });
    window.addEventListener("blur", () => this.release());
  }

  owns({ pointerId }: PointerEvent): boolean {
    return pointerId === this.pointer;
  }

  /** Takes the thing under a pointer that goes down: the left button, or a finger on the right half of the view. */
  take(event: PointerEvent): boolean {
    const { left, width } = this.view.getBoundingClientRect();
    const steers = event.pointerType === "touch" && event.clientX <= left + width / 2;
    if (this.pointer !== null || steers || event.button !== 0 || document.pointerLockElement || !this.host.walks()) return false;
    const found = this.found(event);
    if (!found) return false;
    const { number, point, object } = found;
    this.plane.constant = -point.y;
    this.offset.set(object.position.x - point.x, object.position.z - point.z);
    this.pointer = event.pointerId;
    this.view.classList.add("grasping");
    this.hand.take(number, [object.position.x, object.position.z]);
    return true;
  }

  move(event: PointerEvent): void {
    const at = this.ray(event).ray.intersectPlane(this.plane, new Vector3());
    if (at) this.hand.move(at.x + this.offset.x, at.z + this.offset.y);
  }

  release(): void {
    if (this.pointer === null) return;
    this.pointer = null;
    this.view.classList.remove("grasping");
    this.hand.letGo();
  }

  /** The thing under a pointer that can be pushed. */
  private found(event: PointerEvent): { number: number; point: Vector3; object: Object3D } | null {
    const { world } = this.host.picture;
    const [hit] = this.ray(event).intersectObjects(world.solid, true);
    if (!hit) return null;
    const number = world.placeOf(hit.object);
    return this.host.canBePushed(number) ? { number, point: hit.point, object: hit.object } : null;
  }

  private ray({ clientX, clientY }: PointerEvent): Raycaster {
    const { left, top, width, height } = this.view.getBoundingClientRect();
    const ray = new Raycaster();
    ray.setFromCamera(new Vector2((2 * (clientX - left)) / width - 1, 1 - (2 * (clientY - top)) / height), this.host.picture.stage.camera);
    return ray;
  }
}
