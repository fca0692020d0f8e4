/** Files that come to the page, dropped or opened: each goes where its kind belongs. */

import { isPrivate } from "../address";
import { uploadFile } from "../avatar/upload";
import type { Uploaded } from "../generated/messages";
import type { Session } from "../net/session";
import { text } from "../texts/texts";
import type { Menu } from "../ui/menu";
import type { Notices } from "../ui/notices";
import type { Veil } from "../ui/veil";
import type { Modes } from "./modes";
import { words } from "./words";
import { sceneTitle } from "../texts/scene_titles";

export interface ArrivalsParts {
  readonly modes: Modes;
  readonly menu: Menu;
  readonly notices: Notices;
  readonly veil: Veil;
  configure(change: Parameters<Session["configure"]>[0]): void;
}

export class Arrivals {
  /** Kept to send it again when the server has lost it. */
  private lastFile: File | null = null;

  constructor(private readonly parts: ArrivalsParts) {}

  file(file: File): void {
    const { modes, veil, notices } = this.parts;
    if (/\.elbow$/i.test(file.name)) {
      void modes.replayRun(file);
      return;
    }
    if (/\.json$/i.test(file.name)) {
      void modes.buildFile(file);
      return;
    }
    this.lastFile = file;
    veil.upload(file.name);
    uploadFile(file)
      .then((uploaded) => this.use(uploaded))
      .catch((error: unknown) => {
        this.lastFile = null;
        notices.show("error", words(error));
      })
      .finally(() => veil.upload(null));
  }

  /** The server does not offer the chosen avatar (any more); false to ask for it all the same: someone has shared it. */
  avatarLost(id: string): boolean {
    if (this.lastFile) this.file(this.lastFile);
    else if (isPrivate(id)) return false;
    else this.parts.notices.show("warning", text("app.standIn", id));
    return true;
  }

  /** An avatar is put on, a motion is played, a place is gone to; the motions of an avatar's own file wait in the menu. */
  private use({ avatar, clips, scene }: Uploaded): void {
    const { menu, notices } = this.parts;
    if (scene) {
      this.lastFile = null;
      menu.addScene(scene.name, sceneTitle(scene.title));
      this.parts.configure({ scene: scene.name });
    }
    menu.clips.add(clips);
    if (avatar) {
      menu.addAvatar(avatar.id, avatar.title);
      this.parts.configure({ avatar: avatar.id });
      const brought = text(clips.length === 1 ? "app.oneClip" : "app.clips", avatar.title, clips.length);
      if (clips.length > 0) notices.show("info", brought);
    } else if (clips[0]) {
      this.lastFile = null;
      this.parts.configure({ clip: clips[0].id });
    }
  }
}
