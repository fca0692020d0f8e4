/** Asks the server over HTTP; what goes wrong is one sentence in the page's language. */

import { heard } from "../texts/sayings";
import { text } from "../texts/texts";

/** The answer. @throws Error with one sentence for the user; a call that was called off throws what `fetch` throws */
export async function asked(url: string, init: RequestInit = {}): Promise<Response> {
  const response = await fetch(url, init).catch((error: unknown) => {
    throw init.signal?.aborted ? error : new Error(text("server.silent"));
  });
  if (response.ok) return response;
  const { error } = (await response.json().catch(() => ({}))) as { error?: string };
  throw new Error(error ? heard(error) : text("server.status", response.status));
}

/** Sends a file's bytes. @throws Error */
export function sent(url: string, body: Blob | Float32Array<ArrayBuffer>): Promise<Response> {
  return asked(url, { method: "POST", headers: { "Content-Type": "application/octet-stream" }, body });
}
