/** Things pushed by mouse, finger or keys while the avatar walks, and where the server says that they are. */

import type { ClientMessage, Notice, PoseFrame, Pushed, SceneMessage } from "../generated/messages";
import type { ShownPose } from "../net/pose_timeline";
import type { Picture } from "../picture";
import { LooseThings, NOTHING_LOOSE, type Loose } from "../stage/loose";
import { text } from "../texts/texts";
import { thingName } from "../texts/thing_names";
import { ArrowPushing, type Graspable } from "./arrows";
import { Grip } from "./grip";
import { Hand } from "./hand";

export interface PushingHost {
  readonly view: HTMLElement;
  readonly picture: Picture;
  send(message: ClientMessage): void;
  say(level: Notice["level"], said: string): void;
  /** Whether one walks now: not while a run is replayed. */
  walks(): boolean;
  /** Other tracks count from now on. */
  changed(): void;
  pose(): ShownPose | null;
}

export class Pushing {
  readonly grip: Grip;
  private readonly hand: Hand;
  private readonly arrows: ArrowPushing;
  private things: LooseThings | null = null;

  constructor(private readonly host: PushingHost) {
    const { picture } = host;
    this.hand = new Hand((message) => host.send(message));
    const canBePushed = (number: number) => this.things?.scene.pushable.includes(number) ?? false;
    this.grip = new Grip(host.view, { picture, walks: () => host.walks(), canBePushed }, this.hand);
    this.arrows = new ArrowPushing({
      heading: () => picture.camera.heading, offered: () => this.offered(), chosen: (number) => this.show(number),
    }, this.hand);
  }

  /** The number of what is in hand, for tests. */
  get held(): number | null {
    return this.hand.number;
  }

  /** Whether the arrow keys push a thing. */
  get byArrows(): boolean {
    return this.arrows.holds;
  }

  /** What was pushed in the live scene. */
  get loose(): Loose {
    return this.things?.loose ?? NOTHING_LOOSE;
  }

  /** Another scene: nothing is loose in it. */
  enter(scene: SceneMessage): void {
    this.release();
    this.things = new LooseThings(scene);
  }

  heard(pushed: Pushed): void {
    const before = this.loose;
    const size = before.size;
    this.things?.hear(pushed);
    if (this.loose !== before || this.loose.size !== size) this.host.changed();
  }

  /** With another epoch everything is back where it was. */
  frameCame({ epoch }: PoseFrame): void {
    if (!this.things?.backFor(epoch)) return;
    this.release();
    this.host.changed();
  }

  /** Takes the next thing in hand by keys. */
  next(): void {
    if (!this.host.walks()) return;
    if (this.offered().length === 0) this.host.say("info", text("push.none"));
    else this.arrows.next();
  }

  release(): void {
    this.grip.release();
    this.arrows.release();
  }

  /** Once a frame. */
  update(dt: number): void {
    this.arrows.update(dt);
    this.hand.update(performance.now() / 1000);
  }

  /** What can be pushed, the nearest first. */
  private offered(): readonly Graspable[] {
    const { things, host } = this, pose = host.pose();
    if (!things || !pose) return [];
    const found = things.scene.pushable.map((number): Graspable => {
      const box = host.picture.world.boxes[number];
      return { number, place: box ? [box.center[0], box.center[2]] : [Infinity, Infinity] };
    });
    const away = ({ place }: Graspable) => Math.hypot(place[0] - pose.x, place[1] - pose.z);
    return found.sort((a, b) => away(a) - away(b));
  }

  private show(number: number | null): void {
    this.host.picture.world.hold(number);
    const name = number === null ? undefined : this.things?.scene.obstacles[number]?.name;
    if (name !== undefined) this.host.say("info", text("push.inHand", thingName(name)));
  }
}
