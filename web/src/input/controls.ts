/** All devices together: one intent, turned into commands that go out at once when they change. */

import type { Input } from "../generated/messages";
import { Gamepads } from "./gamepad";
import type { KeyMap } from "./key_map";
import type { Action } from "./action";
import { Keyboard } from "./keyboard";
import { PadFocus } from "./pad_focus";
import { commandsDiffer, mergeIntents, NO_INTENT, steer, type Command, type Intent, type SteeringMode } from "./steering";
import { TouchStick } from "./touch_stick";

const KEEP_ALIVE = 0.2;
const PAD_LOOK_RATE = 2.6;

/** What the controls need from the rest of the page. */
export interface ControlsHost {
  send(input: Input): void;
  action(action: Action): void;
  look(yaw: number, pitch: number): void;
  cameraHeading(): number;
  steering(): SteeringMode;
  openMenu(open: boolean): void;
  /** Whether a thing is in hand that the arrow keys push. */
  pushes(): boolean;
}

export class Controls {
  readonly stick: TouchStick;
  private readonly keyboard: Keyboard;
  private readonly gamepads: Gamepads;
  private padIntent: Intent = NO_INTENT;
  private sent: Command = steer(NO_INTENT, "camera", 0);
  private sentAt = -Infinity;
  private sequence = 0;

  constructor(private readonly host: ControlsHost, stickRing: HTMLElement, keys: KeyMap) {
    this.gamepads = new Gamepads(new PadFocus({ openMenu: (open) => host.openMenu(open), back: () => host.action("escape"), pushes: () => host.pushes() }));
    this.keyboard = new Keyboard(keys, (action) => host.action(action), () => this.flush());
    this.stick = new TouchStick(stickRing, () => this.flush());
  }

  get intent(): Intent {
    return mergeIntents(mergeIntents(this.keyboard.intent, this.stick.intent), this.padIntent);
  }

  /** How many steering keys are held down. */
  get heldKeys(): number {
    return this.keyboard.heldCount;
  }

  /** The number of the last input sent; frames tell which one they obey. */
  get lastSequence(): number {
    return this.sequence;
  }

  get lastCommand(): Command {
    return this.sent;
  }

  /** Reads the gamepad, and sends what has changed or must be kept alive. Once a frame. */
  update(dt: number): void {
    const pad = this.gamepads.poll();
    this.padIntent = pad.intent;
    for (const action of pad.pressed) this.host.action(action);
    if (pad.look[0] !== 0 || pad.look[1] !== 0) {
      this.host.look(pad.look[0] * PAD_LOOK_RATE * dt, pad.look[1] * PAD_LOOK_RATE * dt);
    }
    this.flush();
  }

  /** Says the present command again: a new connection knows nothing of held keys. */
  repeat(): void {
    this.sentAt = -Infinity;
    this.sent = { ...this.sent, forward: NaN };
  }

  private flush(): void {
    const command = steer(this.intent, this.host.steering(), this.host.cameraHeading());
    const now = performance.now() / 1000;
    const idle = command.forward === 0 && command.strafe === 0 && command.turn === 0;
    const due = !idle && now - this.sentAt > KEEP_ALIVE;
    if (!due && !commandsDiffer(command, this.sent)) return;
    this.sent = command;
    this.sentAt = now;
    this.sequence++;
    this.host.send({ type: "input", seq: this.sequence, ...command });
  }
}
