/** Clicks and taps on the view: down and up at the same spot, soon, with nothing else held. Drags are none of them. */

const STILL = 6;
const SOON = 400;

export class FloorClicks {
  private readonly down = new Map<number, readonly [x: number, y: number, time: number]>();
  private spoilt = false;

  /** @param clicked where in the view, CSS pixels from its upper left corner */
  constructor(view: HTMLElement, private readonly clicked: (x: number, y: number) => void) {
    view.addEventListener("pointerdown", (event) => this.begin(event));
    view.addEventListener("pointermove", (event) => this.move(event));
    view.addEventListener("pointerup", (event) => this.end(event, view.getBoundingClientRect()));
    view.addEventListener("pointercancel", (event) => this.down.delete(event.pointerId));
  }

  private begin(event: PointerEvent): void {
    if (this.down.size === 0) this.spoilt = event.button !== 0 || document.pointerLockElement !== null;
    else this.spoilt = true;
    this.down.set(event.pointerId, [event.clientX, event.clientY, event.timeStamp]);
  }

  private move(event: PointerEvent): void {
    const at = this.down.get(event.pointerId);
    if (at && Math.hypot(event.clientX - at[0], event.clientY - at[1]) > STILL) this.spoilt = true;
  }

  private end(event: PointerEvent, view: DOMRect): void {
    const at = this.down.get(event.pointerId);
    this.down.delete(event.pointerId);
    if (!at || this.spoilt || event.timeStamp - at[2] > SOON) return;
    this.clicked(event.clientX - view.left, event.clientY - view.top);
  }
}
