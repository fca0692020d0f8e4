/** Panels by gamepad alone: the cross goes from control to control and changes lists and sliders, A presses, B goes back. */

import { padOnBoard } from "./pad_board";

const [A, B, START, UP, DOWN, LEFT, RIGHT] = [0, 1, 9, 12, 13, 14, 15] as const;
const CROSS: readonly number[] = [UP, DOWN, LEFT, RIGHT];
const ARROWS = [[UP, "ArrowUp"], [DOWN, "ArrowDown"], [LEFT, "ArrowLeft"], [RIGHT, "ArrowRight"]] as const;
const WORKED = [A, B, ...CROSS];
/** Seconds until a held cross goes on, and from then on. */
const WAIT = 0.4;
const AGAIN = 0.12;
const CONTROLS = "button, select, input:not([type=file]), summary, a[href], svg.board";
/** The panels that take the pad when they come up, the uppermost first. */
const PANELS = ["dialog[open]", "#finish:not([hidden])", "#replay", "#build"] as const;
/** Seconds by which a press moves the timeline. */
const SEEK = 0.5;

export interface PadFocusHost {
  /** Opens the menu, or leaves it. */
  openMenu(open: boolean): void;
  /** What Escape does. */
  back(): void;
  /** Whether a thing is in hand, which the cross pushes. */
  pushes(): boolean;
}

export class PadFocus {
  /** The menu was opened by the pad. */
  private inMenu = false;
  private entering = false;
  private readonly pushing = new Set<number>();
  private held: number | null = null;
  private due = 0;

  constructor(private readonly host: PadFocusHost) {}

  /**
   * Works the panel that is up.
   * @param down the buttons that are down
   * @param fresh those of them that went down just now
   * @param now seconds
   * @returns those that are used here
   */
  take(down: ReadonlySet<number>, fresh: ReadonlySet<number>, now: number): ReadonlySet<number> {
    if (fresh.has(START)) this.toggleMenu();
    if (this.entering) this.enter();
    const panels = this.panels();
    if (panels.length === 0 && this.host.pushes()) return this.push(down, fresh);
    if (panels.length === 0) return new Set([START]);
    const controls = panels.flatMap((panel) => [...panel.querySelectorAll<HTMLElement>(CONTROLS)]).filter(canBeUsed);
    const onBoard = new Set([...fresh].filter((button) => !CROSS.includes(button) && padOnBoard(button)));
    if (fresh.has(B) && !onBoard.has(B)) this.back();
    else if (fresh.has(A) && !onBoard.has(A)) (focused(controls) ?? focus(controls[0]))?.click();
    for (const button of CROSS) if (this.goes(button, down, fresh, now) && !padOnBoard(button)) move(controls, button);
    return new Set([START, ...WORKED, ...(panels[0]?.id === "build" ? down : [])]);
  }

  /** The cross does as the arrow keys, B as Escape. */
  private push(down: ReadonlySet<number>, fresh: ReadonlySet<number>): ReadonlySet<number> {
    for (const [button, code] of ARROWS) {
      if (down.has(button) !== this.pushing.has(button)) press(down.has(button) ? "keydown" : "keyup", code);
      if (down.has(button)) this.pushing.add(button);
      else this.pushing.delete(button);
    }
    if (fresh.has(B)) press("keydown", "Escape");
    return new Set([START, B, ...CROSS]);
  }

  private toggleMenu(): void {
    this.inMenu = !this.inMenu;
    this.host.openMenu(this.inMenu);
    this.entering = this.inMenu;
    if (!this.inMenu) leave();
  }

  /** Takes the focus to the menu, as soon as that is to be seen. */
  private enter(): void {
    const first = document.querySelector<HTMLElement>("#scene");
    focus(first ?? undefined);
    this.entering = document.activeElement !== first;
  }

  private back(): void {
    const dialog = document.querySelector<HTMLDialogElement>("dialog[open]");
    if (dialog) dialog.close();
    else if (this.inMenu && !document.querySelector(PANELS.slice(1).join())) this.toggleMenu();
    else this.host.back();
  }

  private panels(): readonly Element[] {
    const up = PANELS.map((panel) => document.querySelector(panel)).find((panel) => panel !== null);
    if (up) return [up];
    return this.inMenu ? [...document.querySelectorAll("#menu, #bar")] : [];
  }

  /** Whether a button of the cross is to act now: when it goes down, and again and again while it is held. */
  private goes(button: number, down: ReadonlySet<number>, fresh: ReadonlySet<number>, now: number): boolean {
    if (fresh.has(button)) {
      this.held = button;
      this.due = now + WAIT;
      return true;
    }
    if (this.held !== button || !down.has(button) || now < this.due) return false;
    this.due = now + AGAIN;
    return true;
  }
}

function press(kind: "keydown" | "keyup", code: string): void {
  window.dispatchEvent(new KeyboardEvent(kind, { code, cancelable: true }));
}

function move(controls: readonly HTMLElement[], button: number): void {
  const at = focused(controls);
  const step = button === UP || button === LEFT ? -1 : 1;
  if (at && (button === LEFT || button === RIGHT) && change(at, step)) return;
  const next = at ? controls.indexOf(at) + step : 0;
  focus(controls[(next + controls.length) % Math.max(1, controls.length)]);
}

/** Changes a list, a slider or a number by one; whether there was anything to change. */
function change(control: HTMLElement, step: number): boolean {
  if (control instanceof HTMLSelectElement) {
    control.selectedIndex = Math.min(control.options.length - 1, Math.max(0, control.selectedIndex + step));
  } else if (control instanceof HTMLInputElement && ["range", "number"].includes(control.type)) {
    const by = control.step === "any" ? SEEK : Number(control.step) || 1;
    control.value = String(Number(control.value) + step * by);
  } else return false;
  for (const name of ["input", "change"]) control.dispatchEvent(new Event(name, { bubbles: true }));
  return true;
}

function focused(controls: readonly HTMLElement[]): HTMLElement | undefined {
  return controls.find((control) => control.contains(document.activeElement));
}

function focus(control: HTMLElement | undefined): HTMLElement | undefined {
  control?.focus({ focusVisible: true } as FocusOptions);
  control?.scrollIntoView({ block: "nearest" });
  return control;
}

function leave(): void {
  document.querySelector<HTMLElement>("#view")?.focus();
}

function canBeUsed(control: HTMLElement): boolean {
  return control.checkVisibility() && !(control as HTMLButtonElement).disabled;
}
