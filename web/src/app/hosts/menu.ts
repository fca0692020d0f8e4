/** What becomes of what is chosen in the menu. */

import type { Picture } from "../../picture";
import type { MenuListener } from "../../ui/menu";
import type { AddressBar } from "../address_bar";
import type { Arrivals } from "../arrivals";
import type { Deeds } from "../deeds";
import type { Modes } from "../modes";
import type { Taste } from "../taste";

export interface MenuHostParts {
  readonly address: AddressBar;
  readonly arrivals: Arrivals;
  readonly deeds: Deeds;
  readonly modes: Modes;
  readonly picture: Picture;
  readonly taste: Taste;
}

export function menuHost(parts: MenuHostParts): MenuListener {
  return {
    configure: (change) => parts.address.configure(change),
    prefer: (change) => parts.taste.prefer(change),
    overlay: (name, on) => parts.taste.overlay(name, on),
    files: (files) => parts.arrivals.take(files),
    menuCovers: (pixels) => {
      if (!parts.modes.build.active) parts.picture.stage.setCoveredRight(pixels);
    },
    action: (action) => parts.deeds.do(action),
  };
}
