/** What keys, buttons and the menu ask for. */

import type { ViewName } from "../camera/views";

/** Something that one key press does once. */
export type Action =
  | "reset" | "pause" | "step" | "slow" | "cameraMode" | "overlays" | "hideUi" | "assist" | "help" | "recenter"
  | "pointerLock" | "escape" | "menu" | "nextView" | "inset" | "share" | "stepBack" | "replay" | "build" | "push" | "record" | "tour" | "nearer" | "farther" | `view:${ViewName}`;
