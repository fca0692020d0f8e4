/** A guided tour: from stop to stop of a scene, each looked at as the scene says, with its words; any key ends it. */

import type { ViewName } from "../camera/views";
import type { ClientMessage, Going, Notice, Stop } from "../generated/messages";
import { text } from "../texts/texts";

export interface TourHost {
  send(message: ClientMessage): void;
  look(view: ViewName): void;
  say(level: Notice["level"], said: string): void;
  /** Calls back after so many seconds. @returns calls it off */
  after(seconds: number, then: () => void): () => void;
}

export class GuidedTour {
  private stops: readonly Stop[] = [];
  private next = 0;
  private callOff: (() => void) | null = null;

  constructor(private readonly host: TourHost) {}

  /** The number of the stop that is gone to or looked at; null where no tour goes on. */
  get at(): number | null {
    return this.next > 0 ? this.next - 1 : null;
  }

  /** Begins a tour, or ends the one that goes on. */
  toggle(stops: readonly Stop[]): void {
    const begins = this.at === null && stops.length > 0;
    this.end();
    if (!begins) return;
    this.stops = stops;
    this.goOn();
  }

  end(): void {
    this.callOff?.();
    this.callOff = null;
    this.next = 0;
  }

  /** The server's word on the walk to a stop. */
  heard({ state, place }: Going): void {
    const stop = this.at === null ? undefined : this.stops[this.at];
    if (!stop || this.callOff || Math.hypot(place[0] - stop.position[0], place[2] - stop.position[1]) > 1e-3) return;
    if (state === "taken over") this.end();
    else if (state === "arrived") this.callOff = this.host.after(stop.seconds, () => this.goOn());
    else if (state !== "walking") this.callOff = this.host.after(0, () => this.goOn());
  }

  private goOn(): void {
    this.callOff = null;
    const stop = this.stops[this.next];
    if (!stop) {
      this.end();
      this.host.say("info", text("tour.ended"));
      return;
    }
    this.next += 1;
    if (stop.view !== "") this.host.look(stop.view as ViewName);
    if (stop.say) this.host.say("info", stop.say);
    this.host.send({ type: "goto", place: [stop.position[0], stop.height, stop.position[1]] });
  }
}
