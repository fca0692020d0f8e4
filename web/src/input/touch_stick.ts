/** The touch stick: appears where a finger lands on the left of the view; any other finger looks around. */

import { NO_INTENT, radialDeadZone, type Intent } from "./steering";

const RADIUS = 56;
const RUN_PUSH = 1.45;

export class TouchStick {
  private pointer: number | null = null;
  private origin: [number, number] = [0, 0];
  private current: Intent = NO_INTENT;

  /**
   * @param ring the element that shows the stick; its first child is the knob
   * @param onChange called at each change of the stick
   */
  constructor(private readonly ring: HTMLElement, private readonly onChange: () => void) {
    window.addEventListener("blur", () => this.release());
    document.addEventListener("visibilitychange", () => this.release());
  }

  get intent(): Intent {
    return this.current;
  }

  /** Whether the pointer is the stick's. */
  owns(event: PointerEvent): boolean {
    return event.pointerId === this.pointer;
  }

  /** Takes a finger that lands on the left half, if the stick is free. */
  take(event: PointerEvent, view: DOMRect): boolean {
    if (event.pointerType !== "touch" || this.pointer !== null) return false;
    if (event.clientX > view.left + view.width * 0.5) return false;
    this.pointer = event.pointerId;
    this.origin = [event.clientX, event.clientY];
    this.ring.style.translate = `${event.clientX - view.left}px ${event.clientY - view.top}px`;
    this.ring.classList.add("held");
    this.move(event);
    return true;
  }

  move(event: PointerEvent): void {
    const dx = (event.clientX - this.origin[0]) / RADIUS;
    const dy = (event.clientY - this.origin[1]) / RADIUS;
    const [right, back] = radialDeadZone(dx, dy, 0.12, 1);
    this.current = { right, forward: back === 0 ? 0 : -back, strafe: 0, run: Math.hypot(dx, dy) > RUN_PUSH };
    const size = Math.max(1, Math.hypot(dx, dy));
    const knob = this.ring.firstElementChild;
    if (knob instanceof HTMLElement) knob.style.translate = `${(dx / size) * RADIUS}px ${(dy / size) * RADIUS}px`;
    this.ring.classList.toggle("running", this.current.run);
    this.onChange();
  }

  release(): void {
    if (this.pointer === null) return;
    this.pointer = null;
    this.current = NO_INTENT;
    this.ring.classList.remove("held", "running");
    const knob = this.ring.firstElementChild;
    if (knob instanceof HTMLElement) knob.style.translate = "0 0";
    this.ring.style.translate = "";
    this.onChange();
  }
}
