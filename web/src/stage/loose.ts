/** Obstacles that were pushed: each has a track that grows, and stands where it says at any time. */

import type { MovingObstacle, Pushed, SceneMessage } from "../generated/messages";

/** What was pushed, by its number among the scene's obstacles. */
export type Loose = ReadonlyMap<number, MovingObstacle>;

export const NOTHING_LOOSE: Loose = new Map();

/** Seconds: nothing is told of what stands; before the next word after so long it stood all the while. */
const SILENCE = 0.2;
const STEP = 1 / 60;

/** The tracks of what is pushed in a scene. */
export class LooseThings {
  private tracks = new Map<number, MovingObstacle>();
  private epoch = -1;

  constructor(readonly scene: SceneMessage) {}

  /** The tracks since all was where it belongs; they go on growing. */
  get loose(): Loose {
    return this.tracks;
  }

  /** Notes where a thing is. */
  hear({ obstacle, epoch, time, center, yaw }: Pushed): void {
    this.backFor(epoch);
    this.epoch = epoch;
    const thing = this.scene.obstacles[obstacle];
    if (!thing) return;
    let track = this.tracks.get(obstacle);
    if (!track) {
      const { name, form, color } = thing;
      track = { name, form, color, times: [], centers: [], yaws: [], repeat: "once" };
      this.tracks.set(obstacle, track);
    }
    const last = track.times.at(-1), place = track.centers.at(-1);
    if (last !== undefined && place && time - last > SILENCE) add(track, time - STEP, place, yaw);
    if (last === undefined || time > last) add(track, time, center, yaw);
  }

  /** With another epoch all are back where they were. Whether any was loose. */
  backFor(epoch: number): boolean {
    if (this.tracks.size === 0 || epoch === this.epoch) return false;
    this.tracks = new Map();
    return true;
  }
}

function add({ times, centers, yaws }: MovingObstacle, time: number, [x, y, z]: MovingObstacle["centers"][number], yaw: number): void {
  times.push(time);
  centers.push([x, y, z]);
  yaws.push(yaw);
}
