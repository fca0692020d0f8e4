/** One WebSocket that comes back by itself; poses arrive binary, everything else as JSON text. */

import { readPoseFrame, type ClientMessage, type PoseFrame, type ServerMessage } from "../generated/messages";

export type ConnectionState = "connecting" | "open" | "lost";

/** Who listens. */
export interface ConnectionListener {
  pose(frame: PoseFrame): void;
  message(message: ServerMessage): void;
  state(state: ConnectionState): void;
}

const FIRST_DELAY = 250;
const LAST_DELAY = 3000;
const SILENCE = 6000;
const PING_INTERVAL = 1000;

export class Connection {
  private socket: WebSocket | null = null;
  private delay = FIRST_DELAY;
  private heard = 0;
  private timer = 0;
  private roundTrip = NaN;

  constructor(private readonly url: string, private readonly listener: ConnectionListener) {
    window.addEventListener("online", () => this.retryNow());
    document.addEventListener("visibilitychange", () => this.retryNow());
    window.setInterval(() => this.watch(), PING_INTERVAL);
    this.open();
  }

  get isOpen(): boolean {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  /** Milliseconds from a ping to its answer; NaN before the first. */
  get roundTripMs(): number {
    return this.roundTrip;
  }

  /** Sends a message if the line is open; what is said while it is not is lost on purpose. */
  send(message: ClientMessage): void {
    if (this.isOpen) this.socket?.send(JSON.stringify(message));
  }

  private open(): void {
    window.clearTimeout(this.timer);
    this.listener.state(this.delay === FIRST_DELAY ? "connecting" : "lost");
    const socket = new WebSocket(this.url);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.heard = performance.now();
      this.listener.state("open");
    };
    socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => this.receive(event.data);
    socket.onclose = () => this.closed(socket);
    this.socket = socket;
  }

  private receive(data: string | ArrayBuffer): void {
    this.heard = performance.now();
    this.delay = FIRST_DELAY;
    if (typeof data !== "string") {
      const frame = readPoseFrame(data);
      if (frame) this.listener.pose(frame);
      return;
    }
    const message = JSON.parse(data) as ServerMessage;
    if (message.type === "pong") this.roundTrip = performance.now() - message.t;
    this.listener.message(message);
  }

  private closed(socket: WebSocket): void {
    if (socket !== this.socket) return;
    this.socket = null;
    this.listener.state("lost");
    this.timer = window.setTimeout(() => this.open(), this.delay * (0.8 + 0.4 * Math.random()));
    this.delay = Math.min(LAST_DELAY, this.delay * 1.7);
  }

  private retryNow(): void {
    if (this.socket || document.hidden) return;
    this.delay = FIRST_DELAY * 1.7;
    this.open();
  }

  /** Asks for a sign of life, and gives up a line that has gone silent. */
  private watch(): void {
    if (!this.socket || !this.isOpen) return;
    if (performance.now() - this.heard > SILENCE && !document.hidden) {
      const silent = this.socket;
      silent.onclose = silent.onmessage = null;
      silent.close();
      this.closed(silent);
    } else this.send({ type: "ping", t: performance.now() });
  }
}
