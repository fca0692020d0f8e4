/** Files that come to the page, dropped or opened: one after the other, each goes where its kind belongs. */

import { isPrivate } from "../address";
import { uploadFile } from "../avatar/upload";
import type { Uploaded } from "../generated/messages";
import { text } from "../texts/texts";
import type { Menu } from "../ui/menu";
import type { Notices } from "../ui/notices";
import type { Veil } from "../ui/veil";
import type { AddressBar } from "./address_bar";
import { tooLarge } from "./file_size";
import type { Modes } from "./modes";
import { words } from "./words";
import { sceneTitle } from "../texts/scene_titles";

export interface ArrivalsParts {
  readonly modes: Modes;
  readonly menu: Menu;
  readonly notices: Notices;
  readonly veil: Veil;
  readonly address: AddressBar;
}

/** Something that is on its way to the page: what to call it, and what takes it in. */
interface Arrival {
  readonly name: string;
  readonly take: () => Promise<void>;
}

export class Arrivals {
  /** The files of avatars by the names that the server gave them, to send them again when it has lost them. */
  private readonly avatars = new Map<string, File>();
  private readonly waiting: Arrival[] = [];
  /** Of those that came since nothing was on its way: how many are taken in or being so, and how many there are. */
  private begun = 0;
  private all = 0;

  constructor(private readonly parts: ArrivalsParts) {}

  /** Takes files in, in their order, after those that are on their way. */
  take(files: readonly File[]): void {
    this.add(files.map((file) => ({ name: file.name, take: () => this.open(file) })));
  }

  /** Shows the recording that the server was started with. */
  shownRun(): void {
    this.add([{ name: "…", take: () => this.parts.modes.replayRun(null) }]);
  }

  /** The server does not offer the chosen avatar (any more); false to ask for it all the same: someone has shared it. */
  avatarLost(id: string): boolean {
    const file = this.avatars.get(id);
    if (file) this.take([file]);
    else if (isPrivate(id)) return false;
    else this.parts.notices.show("warning", text("app.standIn", id));
    return true;
  }

  private add(arrivals: readonly Arrival[]): void {
    const idle = this.all === 0;
    this.waiting.push(...arrivals);
    this.all += arrivals.length;
    if (idle && this.all > 0) void this.work();
  }

  private async work(): Promise<void> {
    const { veil, notices } = this.parts;
    for (let next = this.waiting.shift(); next; next = this.waiting.shift()) {
      veil.upload(next.name, ++this.begun, this.all);
      await next.take().catch((error: unknown) => notices.show("error", words(error)));
    }
    this.begun = this.all = 0;
    veil.upload(null);
  }

  /** @throws Error with one sentence for the user */
  private async open(file: File): Promise<void> {
    const { modes } = this.parts;
    const refusal = tooLarge(file);
    if (refusal) throw new Error(refusal);
    await checkReadable(file);
    if (/\.elbow$/i.test(file.name)) await modes.replayRun(file);
    else if (/\.json$/i.test(file.name)) await modes.buildFile(await file.text());
    else this.use(await uploadFile(file), file);
  }

  /** An avatar is put on, a motion is played, a place is gone to; the motions of an avatar's own file wait in the menu. */
  private use({ avatar, clips, scene }: Uploaded, file: File): void {
    const { menu, notices } = this.parts;
    if (scene) {
      menu.addScene(scene.name, sceneTitle(scene.title));
      this.parts.address.configure({ scene: scene.name });
    }
    menu.clips.add(clips);
    if (avatar) {
      this.avatars.set(avatar.id, file);
      menu.addAvatar(avatar.id, avatar.title);
      this.parts.address.configure({ avatar: avatar.id });
      const brought = text(clips.length === 1 ? "app.oneClip" : "app.clips", avatar.title, clips.length);
      if (clips.length > 0) notices.show("info", brought);
    } else if (clips[0]) this.parts.address.configure({ clip: clips[0].id });
  }
}

/** A folder is none, nor a file that is gone by now. @throws Error with one sentence for the user */
async function checkReadable(file: File): Promise<void> {
  await file.slice(0, 1).arrayBuffer().catch(() => {
    throw new Error(text("file.unreadable", file.name));
  });
}
