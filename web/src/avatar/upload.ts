/** Sends the file of an avatar, a motion or a place to the server. */

import { MAX_UPLOAD, type Uploaded } from "../generated/messages";
import { uploadUrl } from "../net/endpoints";

/** @throws Error with one sentence for the user when the server does not take the file */
export async function uploadFile(file: File): Promise<Uploaded> {
  if (file.size > MAX_UPLOAD) {
    throw new Error(`${file.name} has ${megabytes(file.size)} MB; at most ${megabytes(MAX_UPLOAD)} MB are taken.`);
  }
  const response = await fetch(uploadUrl(file.name), {
    method: "POST",
    headers: { "Content-Type": "application/octet-stream" },
    body: file,
  });
  const answer = (await response.json().catch(() => ({}))) as Partial<Uploaded> & { error?: string };
  if (!response.ok || !answer.clips) {
    throw new Error(answer.error ?? `${file.name} was not taken (status ${response.status}).`);
  }
  return { avatar: answer.avatar ?? null, clips: answer.clips, scene: answer.scene ?? null };
}

function megabytes(bytes: number): string {
  return (bytes / 1024 / 1024).toFixed(0);
}
