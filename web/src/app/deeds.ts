/** What each action does; the keyboard, the gamepad and the bar share them. */

import { nextView, viewNamed } from "../camera/views";
import type { GoingSomewhere } from "../going/going";
import type { GuidedTour } from "../going/tour";
import type { Action } from "../input/action";
import type { PointerInput } from "../input/pointer";
import type { Session } from "../net/session";
import type { Picture } from "../picture";
import type { Pushing } from "../pushing/pushing";
import { nextScene } from "../results";
import type { FinishCard, FinishDeed } from "../ui/finish_card";
import type { Menu } from "../ui/menu";
import type { StatusLine } from "../ui/status_line";
import type { AddressBar } from "./address_bar";
import type { Keys } from "./keys";
import type { LiveWalk } from "./live_walk";
import type { Modes } from "./modes";
import type { Taste } from "./taste";

type Deed = Exclude<Action, `view:${string}`>;

const SLOW_MOTION = 0.25;
const ZOOM = 1.25;

export interface DeedsParts {
  readonly session: Session;
  readonly picture: Picture;
  readonly taste: Taste;
  readonly modes: Modes;
  readonly address: AddressBar;
  readonly menu: Menu;
  readonly keys: Keys;
  readonly pointer: PointerInput;
  readonly somewhere: GoingSomewhere;
  readonly pushing: Pushing;
  readonly tour: GuidedTour;
  readonly live: LiveWalk;
  readonly statusLine: StatusLine;
  readonly finishCard: FinishCard;
  readonly view: HTMLElement;
}

export class Deeds {
  private readonly all: Readonly<Record<Deed, () => void>>;

  constructor(private readonly parts: DeedsParts) {
    this.all = { ...walking(parts), ...looking(parts) };
  }

  do(action: Action): void {
    const { modes, address, taste } = this.parts;
    if (modes.answers(action)) return;
    if (action.startsWith("view:")) {
      taste.showCamera(viewNamed(action.slice("view:".length)));
      address.show();
    } else this.all[action as Deed]();
  }

  /** After the finish. */
  goOn(deed: FinishDeed): void {
    const { session, menu, address } = this.parts;
    const { scene, assist } = session.settings ?? {};
    if (deed === "replay") {
      this.do("replay");
      return;
    }
    if (deed === "next" && scene) {
      address.configure({ scene: nextScene(scene, menu.offered) });
      return;
    }
    if (deed === "compare") address.configure({ assist: !assist });
    this.do("reset");
  }
}

type Walking = "reset" | "pause" | "step" | "slow" | "assist" | "stepBack" | "replay" | "build" | "push" | "record" | "tour";

/** What is done to the walk. */
function walking({ session, modes, statusLine, finishCard, somewhere, pushing, tour, live }: DeedsParts): Record<Walking, () => void> {
  return {
    reset: () => {
      statusLine.restart();
      finishCard.hide();
      somewhere.forget();
      tour.end();
      session.send({ type: "reset" });
    },
    pause: () => session.send({ type: "clock", paused: !session.settings?.paused }),
    step: () => session.send({ type: "clock", steps: 1 }),
    slow: () => session.send({ type: "clock", speed: (session.settings?.speed ?? 1) < 1 ? 1 : SLOW_MOTION }),
    assist: () => session.configure({ assist: !(session.settings?.assist ?? true) }),
    stepBack: () => undefined,
    replay: () => void modes.toggleReplay(),
    build: () => void modes.toggleBuild(),
    push: () => pushing.next(),
    record: () => void modes.saveRecording(),
    tour: () => tour.toggle(live.scene?.tour ?? []),
  };
}

/** What is done to picture and panels. */
function looking(parts: DeedsParts): Record<Exclude<Deed, Walking>, () => void> {
  const { picture, taste, address, pointer, menu, keys, finishCard, view } = parts;
  return {
    cameraMode: () => taste.toggleSteering(),
    recenter: () => picture.camera.recenter(),
    nearer: () => picture.camera.zoom(1 / ZOOM),
    farther: () => picture.camera.zoom(ZOOM),
    pointerLock: () => pointer.toggleLock(),
    overlays: () => taste.toggleAllOverlays(),
    hideUi: () => taste.setBare(!taste.bare),
    menu: () => menu.setOpen(!menu.isOpen),
    nextView: () => {
      taste.showCamera(nextView(picture.camera.viewName));
      address.show();
    },
    inset: () => taste.prefer({ inset: !taste.preferences.inset }),
    share: () => address.share(),
    help: () => keys.help.toggle(),
    escape: () => {
      finishCard.hide();
      taste.setBare(false);
      view.focus();
    },
  };
}
