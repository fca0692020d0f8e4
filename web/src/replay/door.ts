/** The way into the replay: keeps the walks from the beginning on, and fetches the rest of the replay when it is wanted. */

import type { AvatarMessage, PoseFrame, SceneMessage, Settings } from "../generated/messages";
import type { ShownPose } from "../net/pose_timeline";
import type { Action } from "../input/action";
import type { Loose } from "../stage/loose";
import { heard } from "../texts/sayings";
import { text } from "../texts/texts";
import { WalkKeeper, type Circumstances } from "./keeper";
import type { Replay, ReplayHost, ReplayState } from "./replay";
import { WalkStore } from "./store";
import type { Take } from "./take";

/** What is shown live. */
export interface LiveShown {
  readonly scene: SceneMessage | null;
  readonly loose: Loose;
  readonly avatar: AvatarMessage | null;
}

export class ReplayDoor {
  private readonly keeper = new WalkKeeper();
  private readonly store = new WalkStore(() => this.keeper.takes());
  /** Of earlier visits; fetched when they are first wanted. */
  private earlier: readonly Take[] | null = null;
  /** Runs out of files. */
  private readonly files: Take[] = [];
  private replay: Replay | null = null;
  private circumstances: Circumstances | null = null;

  constructor(private readonly host: ReplayHost) {}

  /** Whether a run is shown in place of the live walk. */
  get active(): boolean {
    return this.replay?.active ?? false;
  }

  get state(): ReplayState | null {
    return this.replay?.state ?? null;
  }

  /** Notes what is shown live from now on; a motion clip is no walk. */
  live({ scene, loose, avatar }: LiveShown, settings: Settings | null): void {
    const walks = scene && avatar && settings?.clip === "";
    this.circumstances = walks ? { scene, loose, avatar, planner: settings.planner } : null;
  }

  /** Keeps a live frame. */
  keep(frame: PoseFrame): void {
    this.keeper.add(frame, this.circumstances);
  }

  /** Opens the last walk, or closes the replay. */
  async toggle(): Promise<void> {
    if (this.active) {
      this.close();
      return;
    }
    const takes = await this.every();
    const last = takes.at(-1);
    if (last) await this.open(takes, last);
    else this.host.say("info", text("replay.none"));
  }

  close(): void {
    this.replay?.close();
  }

  /** Shows a recording: a file, or the one that the server was started with. @throws Error with one sentence for the user */
  async showRun(file: File | null): Promise<void> {
    const { readRun, shownRun } = await import("./run_file");
    const { take, run } = await (file ? readRun(file) : shownRun());
    this.files.push(take);
    await this.open(await this.every(), take);
    if (run.standIn) this.host.say("warning", text("replay.standIn", run.standIn));
    if (run.note) this.host.say("warning", heard(run.note));
  }

  /** The next pose of the replay; null where none is shown. */
  advance(dt: number): ShownPose | null {
    return this.replay?.advance(dt) ?? null;
  }

  /** Whether the replay has an answer of its own to an action, and gives it. */
  answers(action: Action): boolean {
    const { replay } = this;
    if (!replay?.active) return false;
    const deeds: Readonly<Partial<Record<Action, () => void>>> = {
      pause: () => replay.toggle(), step: () => replay.step(1), stepBack: () => replay.step(-1), reset: () => replay.seek(0),
      escape: () => replay.close(), slow: () => undefined, assist: () => undefined, overlays: () => undefined,
    };
    const deed = deeds[action];
    deed?.();
    return deed !== undefined;
  }

  /** In other colours. */
  repaint(): void {
    this.replay?.repaint();
  }

  /** All that can be replayed, the walk that is going on last. */
  private async every(): Promise<readonly Take[]> {
    this.earlier ??= await this.store.load();
    return [...this.files, ...this.earlier, ...this.keeper.takes()];
  }

  private async open(takes: readonly Take[], shown: Take): Promise<void> {
    const { Replay } = await import("./replay");
    this.replay ??= new Replay(this.host);
    this.replay.open(takes, shown);
  }
}
