/** Going to a place that is clicked on the floor: the question to the server, and what the page shows of its answers. */

import { Plane, Raycaster, Vector2, Vector3, type Intersection } from "three";
import type { ClientMessage, Going, Notice } from "../generated/messages";
import type { Picture } from "../picture";
import { heard } from "../texts/sayings";
import { text } from "../texts/texts";
import { FloorClicks } from "./floor_click";
import { GoalMarker } from "./marker";

/** Metres above the floor: what is clicked higher than this is no floor, and what is higher than that is the storey above. */
const FLOOR = 0.15;
const ABOVE = 2;
/** The upright part of the normal of a floor, at least: 32 degrees. */
const LEVEL = 0.85;

export interface GoingHost {
  readonly picture: Picture;
  send(message: ClientMessage): void;
  say(level: Notice["level"], said: string): void;
  /** Whether one walks now: not while a run is replayed. */
  walks(): boolean;
}

export class GoingSomewhere {
  /** What the server said last, for tests. */
  last: Going | null = null;
  private readonly marker = new GoalMarker();

  constructor(view: HTMLElement, private readonly host: GoingHost) {
    host.picture.stage.scene.add(this.marker.group);
    new FloorClicks(view, (x, y) => this.clicked(x, y, view));
  }

  /** The server's word on a walk to a place. */
  heard(going: Going): void {
    this.last = going;
    const { palette } = this.host.picture.stage;
    if (going.state === "walking") this.marker.show(going.place, palette.accent, false);
    else if (going.nearest) this.marker.show(going.nearest, palette.accent, true);
    else this.marker.hide();
    if (going.state === "refused") this.host.say("warning", going.nearest ? text("going.offered") : text("going.noWay", heard(going.reason)));
    if (going.state === "given up") this.host.say("warning", text("going.givenUp", heard(going.reason)));
  }

  /** Another scene, or back at the start: nobody goes anywhere. */
  forget(): void {
    this.last = null;
    this.marker.hide();
  }

  private clicked(x: number, y: number, view: HTMLElement): void {
    if (!this.host.walks()) return;
    const place = this.floorAt(x / view.clientWidth, y / view.clientHeight);
    if (place) this.host.send({ type: "goto", place });
  }

  /** The place on a floor under a spot of the view (shares of its width and height), if nothing hides it. */
  private floorAt(right: number, down: number): [number, number, number] | null {
    const { picture } = this.host;
    const ray = new Raycaster();
    ray.setFromCamera(new Vector2(2 * right - 1, 1 - 2 * down), picture.stage.camera);
    const seen = ray
      .intersectObjects(picture.world.solid, true)
      .filter(({ object, point }) => object.visible && point.y < picture.world.drawnUpTo);
    const [first] = seen;
    if (picture.world.hasFloors && first && liesLevel(first)) return [first.point.x, first.point.y, first.point.z];
    const level = picture.floor;
    const floor = ray.ray.intersectPlane(new Plane(new Vector3(0, 1, 0), -level), new Vector3());
    if (!floor) return null;
    const far = floor.distanceTo(ray.ray.origin);
    const hides = seen.some(({ distance, point }) => distance < far - FLOOR && point.y > level + FLOOR && point.y < level + ABOVE);
    return hides ? null : [floor.x, level, floor.z];
  }
}

/** Whether a surface is level enough to be walked on, from whichever side it is seen. */
function liesLevel({ face, object }: Intersection): boolean {
  return face !== null && face !== undefined && Math.abs(face.normal.clone().transformDirection(object.matrixWorld).y) > LEVEL;
}
