/** What is shown and the address line, each following the other. */

import { AddressLine, isPrivate, PLAIN, withOwnAvatar } from "../address";
import type { Session } from "../net/session";
import { parseOverlays } from "../overlays/overlay_names";
import type { Picture } from "../picture";
import { readWishes } from "../preferences";
import type { Notices } from "../ui/notices";
import { shareAddress } from "../ui/share";
import type { Modes } from "./modes";
import type { Taste } from "./taste";

export interface AddressBarParts {
  readonly session: Session;
  readonly picture: Picture;
  readonly taste: Taste;
  readonly notices: Notices;
  readonly modes: Modes;
}

export class AddressBar {
  private readonly line: AddressLine;

  constructor(private readonly parts: AddressBarParts) {
    this.line = new AddressLine((query) => this.goTo(query));
  }

  /** Changes settings as the user wants: what comes of it may be a step to go back by. */
  configure(change: Parameters<Session["configure"]>[0]): void {
    this.line.choose();
    this.parts.session.configure(change);
  }

  /** Writes what is shown into the address line. */
  show(): void {
    const { session, picture, taste } = this.parts;
    const { settings } = session;
    const { overlays } = taste.preferences;
    if (settings && !session.sceneAwaited) this.line.show({ settings, camera: picture.camera.viewName, overlays });
  }

  /** Hands the address on, with the avatar that only this tab has. */
  share(): void {
    const { session, notices } = this.parts;
    const avatar = session.settings?.avatar ?? "";
    void shareAddress(document.title, withOwnAvatar(location.href, avatar), isPrivate(avatar)).then((said) => said && notices.show("info", said));
  }

  /** Goes to the place that an address names: the back button leads there. */
  private goTo(query: URLSearchParams): void {
    const { session, taste, modes } = this.parts;
    modes.showLive();
    const { scene, avatar, planner, queueSize, walkSpeed, style, camera, assist } = readWishes(query);
    session.configure({ scene, avatar, planner, queueSize, walkSpeed, style: style ?? PLAIN, assist: assist ?? true });
    taste.showCamera(camera);
    taste.setOverlays(parseOverlays(query.get("overlays")));
  }
}
