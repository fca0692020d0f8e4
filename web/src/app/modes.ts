/** What takes the place of the live walk: the replay and build mode. The live walk waits meanwhile. */

import { BuildDoor } from "../builder/door";
import type { Controls } from "../input/controls";
import type { Action } from "../input/action";
import type { Session } from "../net/session";
import type { Picture } from "../picture";
import { ReplayDoor } from "../replay/door";
import { saveRecording } from "../replay/recording";
import { text } from "../texts/texts";
import { byId } from "../ui/dom";
import type { FinishCard } from "../ui/finish_card";
import type { Menu } from "../ui/menu";
import type { Notices } from "../ui/notices";
import type { AddressBar } from "./address_bar";
import type { LiveWalk } from "./live_walk";
import { words } from "./words";

export interface ModesParts {
  readonly picture: Picture;
  readonly session: Session;
  readonly controls: Controls;
  readonly menu: Menu;
  readonly notices: Notices;
  readonly finishCard: FinishCard;
  readonly live: LiveWalk;
  readonly address: AddressBar;
}

export class Modes {
  readonly replay: ReplayDoor;
  readonly build: BuildDoor;
  /** One of them has paused the live walk. */
  private held = false;

  constructor(private readonly parts: ModesParts) {
    const { picture, notices } = parts;
    this.replay = new ReplayDoor({
      picture, say: (level, said) => notices.show(level, said), closed: () => this.goOnLive(), dock: (pixels) => leaveBelow(pixels),
    });
    this.build = new BuildDoor({
      picture, avatar: () => parts.session.settings?.avatar ?? "", say: (level, said) => notices.show(level, said),
      dock: (bottom, right) => {
        leaveBelow(bottom);
        picture.stage.setCoveredRight(right);
      },
      closed: () => this.goOnLive(),
      walkIn: ({ name, title }) => {
        parts.menu.addScene(name, title);
        parts.address.configure({ scene: name });
      },
    });
  }

  /** Whether the live walk is what is shown. */
  get live(): boolean {
    return !this.replay.active && !this.build.active;
  }

  /** Whether the mode that is shown has an answer of its own to an action, and gives it. */
  answers(action: Action): boolean {
    return this.replay.answers(action) || this.build.answers(action);
  }

  /** Notes what walks where, for the walks that are kept. */
  noteLive(): void {
    const { live, session } = this.parts;
    this.replay.live(live, session.settings);
  }

  /** Opens the last walk, or closes the replay. */
  async toggleReplay(): Promise<void> {
    await this.replay.toggle();
    if (!this.replay.active) return;
    this.parts.menu.setOpen(false);
    this.hold();
  }

  /** Shows a recording: a file, or the one that the server was started with. @throws Error with one sentence for the user */
  async replayRun(file: File | null): Promise<void> {
    await this.replay.showRun(file);
    this.parts.menu.setOpen(false);
    this.hold();
  }

  /** Hands over the walk so far as a recording, which replays here and elsewhere. */
  async saveRecording(): Promise<void> {
    try {
      await saveRecording(this.parts.live.scene?.name ?? "walk");
    } catch (error) {
      this.parts.notices.show("error", text("replay.notSaved", words(error)));
    }
  }

  /** Opens the scene that is shown for building, or closes build mode. */
  async toggleBuild(): Promise<void> {
    await this.build.toggle(this.parts.live.scene);
    this.beginBuilding();
  }

  /** Builds on the scene that a file holds as text. */
  async buildFile(scene: string): Promise<void> {
    await this.build.showText(scene);
    this.beginBuilding();
  }

  /** Builds on the scene that an address holds, if it holds one. */
  async buildAddress(hash: string): Promise<void> {
    if (await this.build.showAddress(hash)) this.beginBuilding();
  }

  /** Leaves replay and build mode: the live walk is wanted. */
  showLive(): void {
    this.replay.close();
    this.build.close();
  }

  private beginBuilding(): void {
    if (!this.build.active) return;
    this.parts.menu.setOpen(false);
    this.parts.finishCard.hide();
    this.hold();
  }

  private hold(): void {
    const { session } = this.parts;
    if (this.held || session.settings?.paused) return;
    this.held = true;
    session.send({ type: "clock", paused: true });
  }

  /** The live walk is shown again and goes on. */
  private goOnLive(): void {
    const { live, session, controls } = this.parts;
    live.showAgain();
    if (this.held) session.send({ type: "clock", paused: false });
    this.held = false;
    controls.repeat();
    byId("view", HTMLElement).focus();
  }
}

/** Leaves room for a panel at the bottom. */
function leaveBelow(pixels: number): void {
  document.documentElement.style.setProperty("--dock", `${pixels}px`);
}
