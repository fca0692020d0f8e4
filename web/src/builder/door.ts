/** The way into build mode: fetches the rest of it when it is wanted. */

import type { SceneMessage } from "../generated/messages";
import type { Action } from "../input/action";
import { text } from "../texts/texts";
import type { Build, BuildHost, BuildState } from "./build";
import { holdsScene, sceneIn } from "./link";

/** What goes on meaning the same while one builds. */
const KEPT: ReadonlySet<Action> = new Set<Action>(["help", "recenter", "nextView", "inset"]);

export class BuildDoor {
  private build: Build | null = null;

  constructor(private readonly host: BuildHost) {}

  get active(): boolean {
    return this.build?.active ?? false;
  }

  get state(): BuildState | null {
    return this.build?.state ?? null;
  }

  /** Opens the scene that is shown, or closes build mode. */
  async toggle(scene: SceneMessage | null): Promise<void> {
    if (this.active) this.close();
    else await (await this.fetched()).show(scene);
  }

  /** Opens the scene of an address, or of a file; false where an address holds none. */
  async showAddress(hash: string): Promise<boolean> {
    if (!holdsScene(hash)) return false;
    const scene = await sceneIn(hash);
    if (scene) await this.showText(scene);
    else this.host.say("error", text("build.badLink"));
    return scene !== null;
  }

  async showText(scene: string): Promise<void> {
    await (await this.fetched()).showText(scene);
  }

  close(): void {
    this.build?.close();
  }

  /** The server answers again. */
  serverBack(): void {
    this.build?.serverBack();
  }

  /** Whether build mode has an answer of its own to an action, and gives it. */
  answers(action: Action): boolean {
    if (!this.active || KEPT.has(action) || action.startsWith("view:")) return false;
    if (action === "escape" || action === "build") this.close();
    return true;
  }

  private async fetched(): Promise<Build> {
    const { Build: Made } = await import("./build");
    return (this.build ??= new Made(this.host));
  }
}
