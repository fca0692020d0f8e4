/** The page: which parts there are, from the picture to the session, in the order in which they need one another. */

import { GoingSomewhere } from "../going/going";
import { GuidedTour } from "../going/tour";
import { Controls } from "../input/controls";
import { PointerInput } from "../input/pointer";
import { sessionUrl } from "../net/endpoints";
import { Session } from "../net/session";
import { Picture } from "../picture";
import { Pushing } from "../pushing/pushing";
import { readPreferences, readWishes } from "../preferences";
import { BestTimes } from "../results";
import { Steps } from "../steps/steps";
import { byId } from "../ui/dom";
import { listenForFiles } from "../ui/file_drop";
import { FinishCard } from "../ui/finish_card";
import { keepKeysOnView } from "../ui/focus";
import { Hud } from "../ui/hud";
import { Menu } from "../ui/menu";
import { Notices } from "../ui/notices";
import { StatusLine } from "../ui/status_line";
import { Veil } from "../ui/veil";
import { AddressBar } from "./address_bar";
import { Arrivals } from "./arrivals";
import { Deeds } from "./deeds";
import { Frames } from "./frames";
import { Hearing } from "./hearing";
import { controlsHost } from "./hosts/controls";
import { menuHost } from "./hosts/menu";
import { pushingHost } from "./hosts/pushing";
import { reachOf, type Reach } from "./hosts/reach";
import { tasteHost } from "./hosts/taste";
import { tourHost } from "./hosts/tour";
import { Keys } from "./keys";
import { LiveWalk } from "./live_walk";
import { localStore } from "./local_store";
import { Modes } from "./modes";
import { showWhatIsAsked } from "./opening";
import { Subscription } from "./subscription";
import { Taste } from "./taste";

export class App {
  readonly query = new URLSearchParams(location.search);
  readonly wishes = readWishes(this.query);
  private readonly preferences = readPreferences(this.query);

  // What is seen
  readonly view = byId("view", HTMLElement);
  readonly picture = new Picture(this.view, byId("nearest-label", HTMLElement), this.preferences.quality, calm());
  readonly steps = new Steps(this.picture);
  readonly hud = new Hud();
  readonly veil = new Veil();
  readonly notices = new Notices();
  readonly statusLine = new StatusLine();
  readonly finishCard = new FinishCard((deed) => this.deeds.goOn(deed));

  // What is shown: the live walk, or a replay or a scene that is built in its place
  readonly live: LiveWalk = new LiveWalk(this);
  readonly modes: Modes = new Modes(this);
  readonly frames: Frames = new Frames(this);
  readonly reach: Reach = reachOf(this);

  // What the user wants
  readonly menu: Menu = new Menu(menuHost(this), this.preferences);
  readonly taste: Taste = new Taste(this.preferences, tasteHost(this));
  readonly address: AddressBar = new AddressBar(this);
  readonly keys = new Keys();
  readonly controls: Controls = new Controls(controlsHost(this), byId("stick", HTMLElement), this.keys.map);
  readonly pushing: Pushing = new Pushing(pushingHost(this));
  readonly pointer = new PointerInput(this.view, this.picture.camera, [this.pushing.grip, this.controls.stick]);
  readonly somewhere = new GoingSomewhere(this.view, this.reach);
  readonly tour: GuidedTour = new GuidedTour(tourHost(this));
  readonly arrivals: Arrivals = new Arrivals(this);

  // What the server is told, and what it says
  readonly best = new BestTimes(localStore());
  readonly subscription: Subscription = new Subscription(this);
  readonly session: Session = new Session(sessionUrl(this.wishes.scene), new Hearing(this), this.wishes);

  // What can be done to all of them, by keys, buttons and gamepad alike
  readonly deeds: Deeds = new Deeds(this);

  constructor() {
    keepKeysOnView(this.view);
    listenForFiles((files) => this.arrivals.take(files));
    this.subscription.renew();
    this.frames.begin();
    showWhatIsAsked(this);
  }
}

/** Whether the user wants little to move, as often as it is asked. */
function calm(): () => boolean {
  const wanted = window.matchMedia("(prefers-reduced-motion: reduce)");
  return () => wanted.matches;
}
