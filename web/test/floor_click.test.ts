import { describe, expect, it } from "vitest";
import { FloorClicks } from "../src/going/floor_click";

type Listener = (event: unknown) => void;

class View {
  private readonly listeners = new Map<string, Listener>();
  addEventListener(name: string, listener: Listener): void { this.listeners.set(name, listener); }
  getBoundingClientRect(): { left: number; top: number } { return { left: 10, top: 20 }; }
  fire(name: string, clientX: number, clientY: number, timeStamp: number, more: object = {}): void {
    this.listeners.get(name)?.({ pointerId: 1, button: 0, clientX, clientY, timeStamp, ...more });
  }
}

function clicksOn(view: View): [number, number][] {
  const clicks: [number, number][] = [];
  Object.defineProperty(globalThis, "document", { value: { pointerLockElement: null }, configurable: true });
  new FloorClicks(view as unknown as HTMLElement, (x, y) => clicks.push([x, y]));
  return clicks;
}

describe("clicks on the floor", () => {
  it("are down and up at the same spot", () => {
    const view = new View(), clicks = clicksOn(view);
    view.fire("pointerdown", 110, 220, 0);
    view.fire("pointermove", 112, 221, 50);
    view.fire("pointerup", 112, 221, 100);
    expect(clicks).toEqual([[102, 201]]);
  });

  it("are no drags, however they end", () => {
    const view = new View(), clicks = clicksOn(view);
    view.fire("pointerdown", 110, 220, 0);
    view.fire("pointermove", 160, 220, 50);
    view.fire("pointermove", 110, 220, 80);
    view.fire("pointerup", 110, 220, 100);
    expect(clicks).toEqual([]);
  });

  it("are no long presses, no other buttons and no second finger", () => {
    const view = new View(), clicks = clicksOn(view);
    view.fire("pointerdown", 110, 220, 0);
    view.fire("pointerup", 110, 220, 900);
    view.fire("pointerdown", 110, 220, 1000, { button: 2 });
    view.fire("pointerup", 110, 220, 1100, { button: 2 });
    view.fire("pointerdown", 110, 220, 2000);
    view.fire("pointerdown", 150, 220, 2010, { pointerId: 2 });
    view.fire("pointerup", 150, 220, 2050, { pointerId: 2 });
    view.fire("pointerup", 110, 220, 2060);
    expect(clicks).toEqual([]);
    view.fire("pointerdown", 110, 220, 3000);
    view.fire("pointerup", 110, 220, 3100);
    expect(clicks).toHaveLength(1);
  });
});
