/** The replay: one of the kept runs, or one from a file, shown in place of the live walk; maybe a second one with it. */

import { words } from "../app/words";
import type { ShownPose } from "../net/pose_timeline";
import type { Picture } from "../picture";
import { text } from "../texts/texts";
import { Companion } from "./companion";
import { curvesOf } from "./curves";
import { canShareFile, shareFile } from "../ui/share";
import { download, Film } from "./film";
import { marksOf } from "./marks";
import { ReplayPanel, type Choice, type Manner, type PanelListener } from "./panel";
import { Player } from "./player";
import { save, type SavedAs } from "./save";
import { durationOf, hasAssist, poseAt, samePlace, setsOff, type Take } from "./take";
import { sceneTitle } from "../texts/scene_titles";

/** The most moments at which curves are drawn. */
const MOMENTS = 1000;
/** Seconds of standing that are shown of a recording before its avatar sets off. */
const LEAD = 0.25;

/** What the replay needs of the page. */
export interface ReplayHost {
  readonly picture: Picture;
  /** The picture leaves so many pixels at the bottom to the panel. */
  dock(pixels: number): void;
  say(level: "info" | "warning" | "error", words: string): void;
  /** The live walk comes back. */
  closed(): void;
}

/** What is shown, for tests and the curious. */
export interface ReplayState {
  readonly time: number;
  readonly duration: number;
  readonly playing: boolean;
  readonly speed: number;
  readonly runs: number;
  readonly frames: number;
  readonly against: string | null;
  readonly filming: boolean;
}

export class Replay implements PanelListener {
  private takes: readonly Take[] = [];
  private take: Take | null = null;
  private player = new Player(0);
  private other: Take | null = null;
  private companion: Companion | null = null;
  private manner: Manner = "ghost";
  private readonly film = new Film();
  private readonly panel = new ReplayPanel(this);

  constructor(private readonly host: ReplayHost) {
    new ResizeObserver(() => host.dock(this.active ? this.panel.element.offsetHeight : 0)).observe(this.panel.element);
  }

  get active(): boolean {
    return this.take !== null;
  }

  get state(): ReplayState | null {
    const { take, player: { time, duration, playing, speed } } = this;
    if (!take) return null;
    const against = this.other && this.manner;
    return { time, duration, playing, speed, runs: this.takes.length, frames: take.frames.length, against, filming: this.film.running };
  }

  /** Shows a run from its beginning; the others can be chosen. */
  open(takes: readonly Take[], shown: Take): void {
    this.takes = takes;
    if (!this.active) {
      document.body.append(this.panel.element);
      document.body.classList.add("replaying");
    }
    this.show(shown);
    this.player.playing = true;
    this.panel.element.querySelector<HTMLElement>("#replay-play")?.focus({ preventScroll: true });
  }

  /** Goes on by `dt` seconds; the pose to show. */
  advance(dt: number): ShownPose | null {
    const { take, player } = this;
    if (!take) return null;
    player.advance(dt);
    const pose = poseAt(take, player.time);
    this.panel.update(player, pose.clearance);
    if (this.film.running && !player.playing) this.endFilm();
    const second = this.other && this.companion && poseAt(this.other, player.time);
    if (second) this.companion?.pose(second, this.manner === "beside", dt);
    this.host.picture.beside = second && this.companion && this.manner === "beside" ? { pose: second, group: this.companion.group } : null;
    return pose;
  }

  /** Draws the curves anew, in other colours. */
  repaint(): void {
    this.panel.redraw();
  }

  // What the user does.

  toggle(): void {
    this.player.toggle();
  }

  step(steps: number): void {
    this.player.step(steps);
  }

  seek(time: number): void {
    this.player.seek(time);
  }

  setSpeed(speed: number): void {
    this.player.speed = speed;
  }

  setLoop(loop: boolean): void {
    this.player.loop = loop;
  }

  choose(id: number): void {
    const take = this.takes.find((one) => one.id === id);
    if (take) this.show(take);
  }

  compare(id: number | null, manner: Manner): void {
    this.manner = manner;
    const other = this.takes.find((one) => one.id === id) ?? null;
    if (other !== this.other) this.setOther(other);
    this.describe();
  }

  /** Films the run from where it stands to its end, or ends the film. */
  filmOrEnd(): void {
    const { player, host } = this;
    if (this.film.running) this.endFilm();
    else if (!Film.possible) host.say("warning", text("replay.noFilm"));
    else {
      player.playing = false;
      player.toggle();
      this.panel.offerFilm(null);
      this.film.begin(host.picture.stage.canvas, "elbowroom", (film) => this.filmed(film));
      this.panel.showFilming(true);
    }
  }

  /** A film is there: it is a download, and where there is a dialog for it, it can be sent on. */
  private filmed(film: File): void {
    download(film, film.name);
    if (!canShareFile(film)) return;
    this.panel.offerFilm(() => {
      shareFile(film).catch((error: unknown) => this.host.say("error", words(error)));
    });
  }

  save(ending: SavedAs): void {
    if (!this.take) return;
    const { host } = this;
    save(this.take, ending).then(
      (note) => note && host.say("info", note),
      (error: unknown) => host.say("error", text("replay.notSaved", words(error))),
    );
  }

  close(): void {
    if (!this.take) return;
    if (this.film.running) this.endFilm();
    this.setOther(null);
    this.host.picture.beside = null;
    this.take = null;
    this.panel.element.remove();
    document.body.classList.remove("replaying");
    this.host.dock(0);
    this.host.closed();
  }

  private endFilm(): void {
    this.film.end();
    this.panel.showFilming(false);
  }

  private show(take: Take): void {
    const { speed, loop } = this.player;
    this.player = Object.assign(new Player(durationOf(take)), { speed, loop });
    const { picture } = this.host;
    this.take = take;
    if (this.other && (this.other === take || !samePlace(this.other, take))) this.setOther(null);
    const failed = (error: unknown): void => this.host.say("error", words(error));
    picture.showScene(take.scene, take.loose);
    picture.showModel().catch(failed);
    if (picture.shownAvatar !== take.avatar) picture.showAvatar(take.avatar).catch(failed);
    if (take.file) this.player.seek(setsOff(take) - LEAD);
    this.describe();
  }

  private setOther(other: Take | null): void {
    this.companion?.dispose();
    this.companion = null;
    this.other = other;
    if (!other) return;
    const { stage } = this.host.picture;
    const companion = new Companion(other.avatar, stage.currentQuality.rich, stage.palette.ghost);
    stage.scene.add(companion.group);
    companion.load().catch((error: unknown) => this.host.say("error", words(error)));
    this.companion = companion;
  }

  private describe(): void {
    const { take, other } = this;
    if (!take) return;
    const choice = (one: Take): Choice => ({ id: one.id, title: this.titleOf(one) });
    const others = this.takes.filter((one) => one !== take && samePlace(one, take));
    this.panel.showChoices(this.takes.map(choice).reverse(), take.id, others.map(choice).reverse(), other?.id ?? null);
    const seconds = this.player.duration;
    const curves = (one: Take) => curvesOf(one, seconds, Math.min(MOMENTS, one.frames.length));
    this.panel.showChart({
      curves: curves(take), marks: marksOf(take), other: other && curves(other), seconds,
      titles: [text("replay.clearance"), text("replay.joints")],
    });
  }

  private titleOf(take: Take): string {
    const name = take.file || sceneTitle(take.scene.title);
    const how = hasAssist(take) ? take.planner : text("replay.noAssist");
    return `${this.takes.indexOf(take) + 1} · ${how} · ${durationOf(take).toFixed(1)} s · ${name}`;
  }
}
