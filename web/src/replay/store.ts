/** Keeps the last walks in this browser, so that they can be replayed after the page is loaded again. */

import type { PoseFrame } from "../generated/messages";
import type { Take } from "./take";

/** Frames of all walks that are kept: three minutes; the oldest walks go first. */
export const MOST_KEPT = 10_800;
const NAME = "elbowroom.walks";
const SECONDS = 4;

/** What is kept of a walk besides its frames. */
type Kept = Omit<Take, "frames" | "id"> & { readonly walk: string; readonly count: number };
/** Some of its frames, one after the other. */
interface Part {
  readonly walk: string;
  readonly first: number;
  readonly frames: readonly PoseFrame[];
}

/** Which of some walks, the oldest first with so many frames each, are kept: the newest that fit, and one at least. */
export function keptOf<T extends { readonly count: number }>(walks: readonly T[], most = MOST_KEPT): T[] {
  let frames = 0;
  const fits = walks.map((walk) => walk.count).reverse().map((count, i) => (frames += count) <= most || i === 0).reverse();
  return walks.filter((_, i) => fits[i]);
}

export class WalkStore {
  /** Of each walk of this page how many frames are kept already. */
  private readonly written = new Map<string, number>();
  private readonly begun = Date.now();
  private busy = false;

  /** @param takes the walks of this page, the oldest first */
  constructor(private readonly takes: () => readonly Take[]) {
    window.setInterval(() => void this.save(), 1000 * SECONDS);
    document.addEventListener("visibilitychange", () => void this.save());
    window.addEventListener("pagehide", () => void this.save());
  }

  /** The walks that earlier visits have left, the oldest first; none where the browser keeps nothing. */
  async load(): Promise<Take[]> {
    try {
      const database = await opened();
      const [walks, parts] = await all(database);
      const before = walks.filter(({ walk }) => !walk.startsWith(`${this.begun}-`));
      return before.map((walk, i) => taken(walk, parts, -1000 - i)).filter((take) => take.frames.length > 0);
    } catch {
      return [];
    }
  }

  /** Writes what is new, and forgets the oldest walks where there are too many. */
  private async save(): Promise<void> {
    if (this.busy) return;
    this.busy = true;
    try {
      const news = this.takes().filter((take) => take.frames.length > (this.written.get(this.nameOf(take)) ?? 0));
      if (news.length > 0) await this.write(await opened(), news);
    } catch {
      return; // a browser that keeps nothing, or has no room
    } finally {
      this.busy = false;
    }
  }

  private async write(database: IDBDatabase, news: readonly Take[]): Promise<void> {
    const [walks] = await all(database);
    const mine = news.map((take): Kept => {
      const { frames, id: _, ...rest } = take;
      return { ...rest, walk: this.nameOf(take), count: frames.length };
    });
    const names = new Set(mine.map(({ walk }) => walk));
    const every = [...walks.filter(({ walk }) => !names.has(walk)), ...mine];
    const kept = new Set(keptOf(every).map(({ walk }) => walk));
    const change = database.transaction(["walks", "parts"], "readwrite");
    for (const { walk } of every.filter((one) => !kept.has(one.walk))) {
      change.objectStore("walks").delete(walk);
      change.objectStore("parts").delete(IDBKeyRange.bound([walk, 0], [walk, Infinity]));
    }
    mine.forEach((walk, i) => {
      if (!kept.has(walk.walk)) return;
      const first = this.written.get(walk.walk) ?? 0;
      change.objectStore("walks").put(walk);
      change.objectStore("parts").put({ walk: walk.walk, first, frames: news[i]?.frames.slice(first) ?? [] } satisfies Part);
      this.written.set(walk.walk, walk.count);
    });
    await done(change);
  }

  private nameOf({ id }: Take): string {
    return `${this.begun}-${String(id).padStart(6, "0")}`;
  }
}

function taken({ walk, count: _, ...rest }: Kept, parts: readonly Part[], id: number): Take {
  const frames = parts.filter((part) => part.walk === walk).sort((a, b) => a.first - b.first).flatMap((part) => part.frames);
  return { ...rest, id, frames };
}

function opened(): Promise<IDBDatabase> {
  return new Promise((resolve, reject) => {
    const request = indexedDB.open(NAME, 1);
    request.onupgradeneeded = () => {
      request.result.createObjectStore("walks", { keyPath: "walk" });
      request.result.createObjectStore("parts", { keyPath: ["walk", "first"] });
    };
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error ?? new Error("nothing is kept here"));
  });
}

async function all(database: IDBDatabase): Promise<[Kept[], Part[]]> {
  const reading = database.transaction(["walks", "parts"]);
  const walks = reading.objectStore("walks").getAll() as IDBRequest<Kept[]>;
  const parts = reading.objectStore("parts").getAll() as IDBRequest<Part[]>;
  await done(reading);
  return [walks.result, parts.result];
}

function done(change: IDBTransaction): Promise<void> {
  return new Promise((resolve, reject) => {
    change.oncomplete = () => resolve();
    change.onerror = change.onabort = () => reject(change.error ?? new Error("not kept"));
  });
}
