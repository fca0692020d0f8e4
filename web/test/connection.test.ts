import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { Connection, type ConnectionState } from "../src/net/connection";

class FakeSocket {
  static readonly OPEN = 1;
  static made: FakeSocket[] = [];
  readyState = 0;
  sent: string[] = [];
  onopen: (() => void) | null = null;
  onmessage: ((event: { data: unknown }) => void) | null = null;
  onclose: ((event: { reason: string }) => void) | null = null;

  constructor(readonly url: string) {
    FakeSocket.made.push(this);
  }

  static get last(): FakeSocket {
    return FakeSocket.made.at(-1) as FakeSocket;
  }

  open(): void {
    this.readyState = 1;
    this.onopen?.();
  }

  say(message: unknown): void {
    this.onmessage?.({ data: JSON.stringify(message) });
  }

  send(text: string): void {
    this.sent.push(text);
  }

  close(reason = ""): void {
    this.readyState = 3;
    this.onclose?.({ reason });
  }
}

let states: [ConnectionState, string][] = [];
let now = 0;

beforeEach(() => {
  vi.useFakeTimers();
  const target = { addEventListener: () => undefined, setTimeout, clearTimeout, setInterval };
  vi.stubGlobal("window", target);
  vi.stubGlobal("document", { ...target, hidden: false });
  vi.stubGlobal("WebSocket", FakeSocket);
  now = 0;
  vi.spyOn(performance, "now").mockImplementation(() => now);
  FakeSocket.made = [];
  states = [];
  const listener = {
    pose: () => undefined,
    message: () => undefined,
    state: (state: ConnectionState, why: string) => states.push([state, why]),
  };
  new Connection("ws://here/ws", listener);
});

afterEach(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
  vi.restoreAllMocks();
});

describe("a line to the server", () => {
  it("stays while the page itself stands still, however long", () => {
    FakeSocket.last.open();
    FakeSocket.last.say({ type: "hello" });
    now += 30_000; // the page hung: one tick of its timer, and the messages wait behind it
    vi.advanceTimersByTime(1000);
    FakeSocket.last.say({ type: "pong", t: 0 });
    vi.advanceTimersByTime(5000);
    expect(states.map(([state]) => state)).toEqual(["connecting", "open"]);
    expect(FakeSocket.made).toHaveLength(1);
  });

  it("is given up when several pings in a row stay without any answer", () => {
    FakeSocket.last.open();
    vi.advanceTimersByTime(6000);
    expect(states.at(-1)?.[0]).toBe("open");
    vi.advanceTimersByTime(1000);
    expect(states.at(-1)).toEqual(["lost", "The server does not answer"]);
  });

  it("says what happened: nobody answers, the line broke, or the server has closed it", () => {
    FakeSocket.last.close();
    expect(states.at(-1)).toEqual(["lost", "The server does not answer"]);
    vi.advanceTimersByTime(400);
    FakeSocket.last.open();
    FakeSocket.last.close();
    expect(states.at(-1)).toEqual(["lost", "The line to the server broke"]);
    vi.advanceTimersByTime(800);
    FakeSocket.last.open();
    FakeSocket.last.close("it has 8 sessions");
    expect(states.at(-1)).toEqual(["lost", "The server has closed the line (it has 8 sessions)"]);
  });

  it("asks a server that is full less and less often, though it answers", () => {
    for (let i = 0; i < 8; i++) {
      FakeSocket.last.open();
      FakeSocket.last.say({ type: "notice", level: "error", message: "full" });
      FakeSocket.last.close("full");
      const made = FakeSocket.made.length;
      vi.advanceTimersByTime(i < 7 ? 3700 : 2300);
      expect(FakeSocket.made.length - made).toBe(i < 7 ? 1 : 0);
    }
  });
});
