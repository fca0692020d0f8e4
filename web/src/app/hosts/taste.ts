/** What follows what the user prefers. */

import type { Picture } from "../../picture";
import type { Menu } from "../../ui/menu";
import type { AddressBar } from "../address_bar";
import type { Modes } from "../modes";
import type { Subscription } from "../subscription";
import type { TasteHost } from "../taste";

export interface TasteHostParts {
  readonly picture: Picture;
  readonly menu: Menu;
  readonly modes: Modes;
  readonly subscription: Subscription;
  readonly address: AddressBar;
}

export function tasteHost(parts: TasteHostParts): TasteHost {
  return {
    picture: parts.picture,
    menu: parts.menu,
    repainted: () => parts.modes.replay.repaint(),
    overlaysChanged: () => {
      parts.subscription.renew();
      parts.address.show();
    },
  };
}
