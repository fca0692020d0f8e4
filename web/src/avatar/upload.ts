/** Sends the file of an avatar, a motion or a place to the server. */

import type { Uploaded } from "../generated/messages";
import { sent } from "../net/asked";
import { uploadUrl } from "../net/endpoints";

/** @throws Error with one sentence for the user when the server does not take the file */
export async function uploadFile(file: File): Promise<Uploaded> {
  return (await sent(uploadUrl(file.name), file)).json() as Promise<Uploaded>;
}
