/** One WebSocket that comes back by itself; poses arrive binary, everything else as JSON text. */

import { readPoseFrame, type ClientMessage, type PoseFrame, type ServerMessage } from "../generated/messages";
import { heard } from "../texts/sayings";
import { text } from "../texts/texts";

export type ConnectionState = "connecting" | "open" | "lost";

/** Who listens. */
export interface ConnectionListener {
  pose(frame: PoseFrame): void;
  message(message: ServerMessage): void;
  /** @param why for a lost line: one clause for the user, such as "the server does not answer" */
  state(state: ConnectionState, why: string): void;
}

const FIRST_DELAY = 250;
const LAST_DELAY = 3000;
const PING_INTERVAL = 1000;
/** So many pings without a word in answer, and the line is given up. */
const UNANSWERED = 6;

export class Connection {
  private socket: WebSocket | null = null;
  private delay = FIRST_DELAY;
  /** Pings since the last word: a page that has itself stood still has sent none meanwhile. */
  private unanswered = 0;
  private why = "";
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
    this.listener.state(this.why === "" ? "connecting" : "lost", this.why);
    const socket = new WebSocket(this.url);
    socket.binaryType = "arraybuffer";
    let opened = false;
    socket.onopen = () => {
      opened = true;
      this.unanswered = 0;
      this.listener.state("open", "");
    };
    socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => this.receive(event.data);
    socket.onclose = ({ reason }) => this.closed(socket, reason ? text("server.closed", heard(reason)) : text(opened ? "server.broke" : "server.silent"));
    this.socket = socket;
  }

  private receive(data: string | ArrayBuffer): void {
    this.unanswered = 0;
    if (typeof data !== "string") {
      this.delay = FIRST_DELAY; // a session is there, which a server that has enough of them does not give
      this.why = "";
      const frame = readPoseFrame(data);
      if (frame) this.listener.pose(frame);
      return;
    }
    const message = JSON.parse(data) as ServerMessage;
    if (message.type === "pong") this.roundTrip = performance.now() - message.t;
    this.listener.message(message);
  }

  private closed(socket: WebSocket, why: string): void {
    if (socket !== this.socket) return;
    this.socket = null;
    this.why = why;
    this.listener.state("lost", why);
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
    if (this.unanswered >= UNANSWERED && !document.hidden) {
      const silent = this.socket;
      silent.onclose = silent.onmessage = null;
      silent.close();
      this.closed(silent, text("server.silent"));
      return;
    }
    this.unanswered++;
    this.send({ type: "ping", t: performance.now() });
  }
}
