/** Mouse and touch on the view: drag a thing to push it, elsewhere to look, wheel or pinch to zoom, the stick on the left, pointer lock on request. */

const LOOK_RATE = 0.0052;
const TOUCH_LOOK_RATE = 0.0068;
const WHEEL_RATE = 0.0011;

/** What the pointer does to the camera. */
export interface LookTarget {
  turn(yaw: number, pitch: number): void;
  zoom(factor: number): void;
}

/** Who may take a pointer that goes down, before it looks around: until it is released. */
export interface PointerTaker {
  take(event: PointerEvent, view: DOMRect): boolean;
  owns(event: PointerEvent): boolean;
  move(event: PointerEvent): void;
  release(): void;
}

export class PointerInput {
  private readonly looking = new Map<number, [number, number]>();
  private pinch = 0;

  constructor(
    private readonly view: HTMLElement, private readonly camera: LookTarget, private readonly takers: readonly PointerTaker[],
  ) {
    view.addEventListener("pointerdown", (event) => this.down(event));
    view.addEventListener("pointermove", (event) => this.move(event));
    for (const name of ["pointerup", "pointercancel", "lostpointercapture"] as const) {
      view.addEventListener(name, (event) => this.up(event));
    }
    view.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    view.addEventListener("contextmenu", (event) => event.preventDefault());
    document.addEventListener("mousemove", (event) => this.lockedMove(event));
  }

  /** Locks the pointer to the view, or sets it free. */
  toggleLock(): void {
    if (document.pointerLockElement) document.exitPointerLock();
    else void Promise.resolve(this.view.requestPointerLock()).catch(() => undefined);
  }

  private down(event: PointerEvent): void {
    if (document.activeElement instanceof HTMLElement) document.activeElement.blur();
    try {
      this.view.setPointerCapture(event.pointerId);
    } catch {
      // A synthetic pointer has no capture; the drag works without.
    }
    const view = this.view.getBoundingClientRect();
    if (this.takers.some((taker) => taker.take(event, view))) return;
    this.looking.set(event.pointerId, [event.clientX, event.clientY]);
    this.pinch = 0;
  }

  private move(event: PointerEvent): void {
    const owner = this.takers.find((taker) => taker.owns(event));
    if (owner) {
      owner.move(event);
      return;
    }
    const last = this.looking.get(event.pointerId);
    if (!last || document.pointerLockElement) return;
    this.looking.set(event.pointerId, [event.clientX, event.clientY]);
    if (this.looking.size === 2) {
      this.pinchZoom();
      return;
    }
    const rate = event.pointerType === "touch" ? TOUCH_LOOK_RATE : LOOK_RATE;
    this.camera.turn((event.clientX - last[0]) * rate, (event.clientY - last[1]) * rate);
  }

  private up(event: PointerEvent): void {
    for (const taker of this.takers) if (taker.owns(event)) taker.release();
    this.looking.delete(event.pointerId);
    this.pinch = 0;
  }

  private pinchZoom(): void {
    const [a, b] = [...this.looking.values()];
    if (!a || !b) return;
    const spread = Math.hypot(a[0] - b[0], a[1] - b[1]);
    if (this.pinch > 0 && spread > 0) this.camera.zoom(this.pinch / spread);
    this.pinch = spread;
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    const pixels = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? event.deltaY * 32 : event.deltaY;
    this.camera.zoom(Math.exp(Math.max(-400, Math.min(400, pixels)) * WHEEL_RATE));
  }

  private lockedMove(event: MouseEvent): void {
    if (document.pointerLockElement !== this.view) return;
    this.camera.turn(event.movementX * LOOK_RATE * 0.6, event.movementY * LOOK_RATE * 0.6);
  }
}
