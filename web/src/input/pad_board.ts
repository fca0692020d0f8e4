/** The board of build mode by gamepad: buttons are the keys that work it, the shoulders go from thing to thing. */

const [PREVIOUS, NEXT] = [4, 5] as const;
const ARROWS: Readonly<Record<number, string>> = { 12: "ArrowUp", 13: "ArrowDown", 14: "ArrowLeft", 15: "ArrowRight" };
const KEYS: Readonly<Record<number, string>> = { 0: "Enter", 1: "Escape", 2: "r", 3: "c", 6: "-", 7: "+", 8: "Delete", 10: "PageDown", 11: "PageUp" };

/** Does what a button is for while the board, or a thing on it, has the focus. @returns whether it was for anything */
export function padOnBoard(button: number): boolean {
  const board = document.querySelector<SVGElement>("#build .board");
  if (!board?.contains(document.activeElement)) return false;
  if (button === PREVIOUS || button === NEXT) {
    const things = [...board.querySelectorAll<SVGElement>("[tabindex]")];
    const at = things.findIndex((thing) => thing === document.activeElement), step = button === NEXT ? 1 : -1;
    things[(at < 0 && step < 0 ? things.length - 1 : at + step + things.length) % Math.max(1, things.length)]?.focus();
    return true;
  }
  const key = ARROWS[button] ?? KEYS[button];
  if (key === undefined) return false;
  const event = new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true });
  document.activeElement?.dispatchEvent(event);
  if (!board.contains(document.activeElement)) board.focus();
  return event.defaultPrevented;
}
