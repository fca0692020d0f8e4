/** The board by keyboard. */

import type { Editor } from "./editor";
import { KINDS } from "./shapes";
import { inWorld } from "./outline";
import type { Vec2 } from "./plan";

/** What of the board the keys work. */
export interface KeyedBoard {
  readonly center: Vec2;
  zoom(factor: number): void;
  fit(): void;
}

const ARROWS: Readonly<Record<string, Vec2>> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
/** How much nearer or farther one press brings the board. */
export const ZOOM = 1.25;

/** Does what a key is for, and says whether it is for anything. */
export function boardKey(event: KeyboardEvent, editor: Editor, board: KeyedBoard): boolean {
  const { key, shiftKey } = event;
  if (event.altKey) return false;
  if (event.ctrlKey || event.metaKey) return withControl(key.toLowerCase(), shiftKey, editor);
  const arrow = ARROWS[key];
  if (arrow) {
    if (!editor.selected) return false;
    editor.nudge(inWorld(editor.side, arrow), shiftKey);
    return true;
  }
  if (key === "Escape") return leave(editor);
  if (key === "Enter") return editor.use(board.center[0], board.center[1]);
  const kind = KINDS[Number(key) - 1];
  if (kind) editor.place(kind, editor.snapped(board.center[0]), editor.snapped(board.center[1]));
  const deed = deeds(editor, board, shiftKey)[key.toLowerCase()];
  deed?.();
  return deed !== undefined || kind !== undefined;
}

function deeds(editor: Editor, board: KeyedBoard, many: boolean): Readonly<Record<string, () => void>> {
  return {
    pageup: () => editor.nudge([0, 1, 0], many),
    pagedown: () => editor.nudge([0, -1, 0], many),
    r: () => editor.turn(many ? -1 : 1),
    "+": () => editor.grow(1),
    "=": () => editor.grow(1),
    "-": () => editor.grow(-1),
    c: () => editor.copy(),
    t: () => editor.extend(),
    s: () => editor.stop(editor.snapped(board.center[0]), editor.snapped(board.center[1])),
    delete: () => editor.remove(),
    backspace: () => editor.remove(),
    v: () => editor.look(editor.side === "top" ? "side" : "top"),
    home: () => board.fit(),
    i: () => board.zoom(1 / ZOOM),
    o: () => board.zoom(ZOOM),
  };
}

function withControl(key: string, shifted: boolean, editor: Editor): boolean {
  if (key === "z") {
    if (shifted) editor.redo();
    else editor.undo();
  } else if (key === "y") editor.redo();
  else if (key === "d") editor.copy();
  else return false;
  return true;
}

/** Leaves the tool, then the selection; else Escape is not the board's. */
function leave(editor: Editor): boolean {
  if (editor.tool !== "select") editor.take("select");
  else if (editor.selected) editor.select(null);
  else return false;
  return true;
}
