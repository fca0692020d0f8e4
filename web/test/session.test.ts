import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import type { Settings } from "../src/generated/messages";
import { Session, type SessionListener } from "../src/net/session";
import type { SessionWishes } from "../src/preferences";

class FakeSocket {
  static readonly OPEN = 1;
  static last: FakeSocket;
  readonly readyState = 1;
  readonly sent: Record<string, unknown>[] = [];
  onopen: (() => void) | null = null;
  onmessage: ((event: { data: unknown }) => void) | null = null;

  constructor() {
    FakeSocket.last = this;
  }

  send(text: string): void {
    this.sent.push(JSON.parse(text) as Record<string, unknown>);
  }

  say(message: unknown): void {
    this.onmessage?.({ data: JSON.stringify(message) });
  }
}

const wishes = { scene: "gauntlet:5:9", avatar: null, planner: null, queueSize: null, assist: null, walkSpeed: null } as SessionWishes;
const settings = (scene: string) => ({ type: "settings", scene, avatar: "stock", planner: "exact" }) as Settings;
const hello = { type: "hello", protocol: 1, catalog: { scenes: [], avatars: [], clips: [], planners: [], queueSizes: [], walkSpeed: [0, 1] } };

function opened(): Session {
  const listener = new Proxy({}, { get: () => () => undefined }) as SessionListener;
  const session = new Session("ws://here/ws", listener, wishes);
  FakeSocket.last.say(hello);
  FakeSocket.last.say(settings("a"));
  return session;
}

beforeEach(() => {
  const target = { addEventListener: () => undefined, setInterval: () => 0, clearTimeout: () => undefined };
  vi.stubGlobal("window", target);
  vi.stubGlobal("document", target);
  vi.stubGlobal("WebSocket", FakeSocket);
});

afterEach(() => vi.unstubAllGlobals());

describe("a session that lost its server", () => {
  it("goes on as it was: paused, or slow", () => {
    opened();
    expect(FakeSocket.last.sent.filter(({ type }) => type === "clock")).toEqual([]);
    FakeSocket.last.say({ ...settings("a"), paused: true, speed: 0.25 });
    FakeSocket.last.say(hello);
    expect(FakeSocket.last.sent.find(({ type }) => type === "clock")).toEqual({ type: "clock", paused: true, speed: 0.25 });
  });
});

describe("a session that asks for a scene", () => {
  it("knows that it is on its way until the server shows it", () => {
    const session = opened();
    expect(FakeSocket.last.sent.find(({ type }) => type === "configure")).toMatchObject({ scene: "gauntlet:5:9" });
    expect(session.sceneAwaited).toBe(true);
    FakeSocket.last.say({ type: "loading", what: "scene", name: "gauntlet:5:9", active: true });
    FakeSocket.last.say(settings("a"));
    expect(session.sceneAwaited).toBe(true);
    FakeSocket.last.say({ type: "loading", what: "scene", name: "gauntlet:5:9", active: false });
    FakeSocket.last.say(settings("gauntlet:5:9"));
    expect(session.sceneAwaited).toBe(false);
  });

  it("does not ask again for what was refused", () => {
    const session = opened();
    FakeSocket.last.say({ type: "notice", level: "error", message: "scene 'gauntlet:5:9' is not known here" });
    FakeSocket.last.say(settings("a"));
    expect(session.sceneAwaited).toBe(false);
    FakeSocket.last.say(hello);
    expect(FakeSocket.last.sent.filter(({ type }) => type === "configure").at(-1)).toMatchObject({ scene: "a" });
  });
});
