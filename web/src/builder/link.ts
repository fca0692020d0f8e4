/** Small scenes in the address itself: compressed, behind its #, so that no server is told of them. */

import { MAX_SCENE } from "../generated/messages";

/** Addresses beyond this many characters are cut off by some programs. */
const LONGEST = 6000;
const MARK = "#scene=";

/** The address of this page with a scene in it; null where that would be too long. */
export async function linkOf(text: string, address: string): Promise<string | null> {
  const packed = await through(new Blob([text]).stream().pipeThrough(new CompressionStream("deflate-raw")), LONGEST);
  if (!packed) return null;
  const letters = btoa(String.fromCharCode(...packed)).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
  const link = `${address.replace(/#.*/, "")}${MARK}${letters}`;
  return link.length > LONGEST ? null : link;
}

/** Whether an address has a scene in it. */
export function holdsScene(hash: string): boolean {
  return hash.startsWith(MARK);
}

/** The scene in an address, as text; null for one that is broken or far too large. */
export async function sceneIn(hash: string): Promise<string | null> {
  try {
    const letters = hash.slice(MARK.length, MARK.length + LONGEST).replaceAll("-", "+").replaceAll("_", "/");
    const packed = Uint8Array.from(atob(letters), (letter) => letter.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
    const text = await through(stream, MAX_SCENE);
    return text && new TextDecoder().decode(text);
  } catch {
    return null;
  }
}

/** All that comes; null where it is more than `most` bytes. */
async function through(stream: ReadableStream<Uint8Array>, most: number): Promise<Uint8Array | null> {
  const parts: Uint8Array[] = [];
  let size = 0;
  const reader = stream.getReader();
  for (let read = await reader.read(); !read.done; read = await reader.read()) {
    size += read.value.length;
    if (size > most) {
      await reader.cancel();
      return null;
    }
    parts.push(read.value);
  }
  const whole = new Uint8Array(size);
  let at = 0;
  for (const part of parts) {
    whole.set(part, at);
    at += part.length;
  }
  return whole;
}
