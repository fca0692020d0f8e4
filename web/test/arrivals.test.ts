import { afterEach, describe, expect, it, vi } from "vitest";
import { Arrivals, type ArrivalsParts } from "../src/app/arrivals";
import { MAX_UPLOAD } from "../src/generated/messages";

interface Told {
  readonly events: string[];
  readonly parts: ArrivalsParts;
}

/** The parts of a page that only note what they are asked. */
function page(): Told {
  const events: string[] = [];
  const parts = {
    modes: {
      replayRun: async (file: File | null) => {
        events.push(`replay ${file?.name} begins`);
        await Promise.resolve();
        events.push(`replay ${file?.name} ends`);
      },
      buildFile: async (scene: string) => void events.push(`build ${scene}`),
    },
    menu: { addScene: () => undefined, addAvatar: () => undefined, clips: { add: () => undefined } },
    notices: { show: (level: string, said: string) => events.push(`${level}: ${said}`) },
    veil: { upload: (name: string | null, at?: number, all?: number) => events.push(name === null ? "veil off" : `veil ${name} ${at}/${all}`) },
    address: { configure: (change: object) => events.push(`configure ${JSON.stringify(change)}`) },
  };
  return { events, parts: parts as unknown as ArrivalsParts };
}

const named = (name: string, words = "x") => new File([words], name);
const ended = (events: readonly string[]) => vi.waitFor(() => expect(events.at(-1)).toBe("veil off"));

afterEach(() => vi.unstubAllGlobals());

describe("files that come together", () => {
  it("are taken one after the other, in their order, and one that is refused holds up none", async () => {
    const asked: string[] = [];
    vi.stubGlobal("fetch", async (url: string) => {
      const name = new URL(url, "http://x").searchParams.get("name") ?? "";
      asked.push(name);
      if (name === "cat.vrm") return Response.json({ error: "cat.vrm: is no avatar" }, { status: 422 });
      return Response.json({ avatar: { id: "0123456789abcdef", title: "Ann" }, clips: [], scene: null });
    });
    const { events, parts } = page();
    new Arrivals(parts).take([named("cat.vrm"), named("ann.vrm"), named("a.elbow"), named("room.json", "{}")]);
    await ended(events);
    expect(asked).toEqual(["cat.vrm", "ann.vrm"]);
    expect(events).toEqual([
      "veil cat.vrm 1/4", "error: cat.vrm: is no avatar", "veil ann.vrm 2/4", 'configure {"avatar":"0123456789abcdef"}',
      "veil a.elbow 3/4", "replay a.elbow begins", "replay a.elbow ends", "veil room.json 4/4", "build {}", "veil off",
    ]);
  });

  it("wait for those that are on their way already", async () => {
    const { events, parts } = page();
    const arrivals = new Arrivals(parts);
    arrivals.take([named("a.elbow")]);
    arrivals.take([named("b.elbow")]);
    await ended(events);
    const replays = events.filter((event) => event.startsWith("replay"));
    expect(replays).toEqual(["replay a.elbow begins", "replay a.elbow ends", "replay b.elbow begins", "replay b.elbow ends"]);
  });

  it("are refused unsent where they are too large, unread where there is nothing to read", async () => {
    const fetched = vi.fn();
    vi.stubGlobal("fetch", fetched);
    const { events, parts } = page();
    const large = Object.defineProperty(named("large.elbow"), "size", { value: 3 * MAX_UPLOAD });
    const folder = Object.assign(named("folder"), { slice: () => ({ arrayBuffer: () => Promise.reject(new DOMException("gone", "NotFoundError")) }) });
    new Arrivals(parts).take([large, folder]);
    await ended(events);
    expect(fetched).not.toHaveBeenCalled();
    expect(events.filter((event) => event.startsWith("error"))).toEqual([
      "error: large.elbow has 192 MB; files of 64 MB at most are taken", "error: folder cannot be read on this device",
    ]);
  });

  it("say that no server answers, and an avatar that it has lost is sent again", async () => {
    const sent: string[] = [];
    let up = true;
    vi.stubGlobal("fetch", async (url: string) => {
      if (!up) throw new TypeError("Failed to fetch");
      sent.push(url);
      return Response.json({ avatar: { id: "0123456789abcdef", title: "Ann" }, clips: [], scene: null });
    });
    const { events, parts } = page();
    const arrivals = new Arrivals(parts);
    arrivals.take([named("ann.vrm"), named("second.vrm")]);
    await ended(events);
    up = false;
    arrivals.take([named("late.vrm")]);
    await vi.waitFor(() => expect(events).toContain("error: The server does not answer"));
    await ended(events);
    up = true;
    expect(arrivals.avatarLost("0123456789abcdef")).toBe(true);
    await vi.waitFor(() => expect(sent.length).toBe(3));
    expect(arrivals.avatarLost("fedcba9876543210")).toBe(false);
  });
});
