/** What keys, gamepad and stick steer. */

import type { ControlsHost } from "../../input/controls";
import type { Session } from "../../net/session";
import type { Picture } from "../../picture";
import type { Pushing } from "../../pushing/pushing";
import type { Menu } from "../../ui/menu";
import type { Deeds } from "../deeds";
import type { Modes } from "../modes";
import type { Taste } from "../taste";

export interface ControlsHostParts {
  readonly session: Session;
  readonly picture: Picture;
  readonly pushing: Pushing;
  readonly menu: Menu;
  readonly deeds: Deeds;
  readonly modes: Modes;
  readonly taste: Taste;
}

export function controlsHost(parts: ControlsHostParts): ControlsHost {
  return {
    send: (input) => parts.modes.live && parts.session.send(input),
    action: (action) => parts.deeds.do(action),
    look: (yaw, pitch) => parts.picture.camera.turn(yaw, pitch),
    cameraHeading: () => parts.picture.camera.heading,
    steering: () => parts.taste.steering,
    openMenu: (open) => parts.menu.showByPad(open),
    pushes: () => parts.pushing.byArrows,
  };
}
