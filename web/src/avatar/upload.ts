/** Sends an avatar file to the server and asks for it to be used. */

import { MAX_UPLOAD } from "../generated/messages";
import { UPLOAD_URL } from "../net/endpoints";

/** What the server calls the avatar. */
export interface UploadedAvatar {
  readonly id: string;
  readonly title: string;
}

/** @throws Error with one sentence for the user when the server does not take the file */
export async function uploadAvatar(file: File): Promise<UploadedAvatar> {
  if (file.size > MAX_UPLOAD) {
    throw new Error(`${file.name} has ${megabytes(file.size)} MB; at most ${megabytes(MAX_UPLOAD)} MB are taken.`);
  }
  const response = await fetch(`${UPLOAD_URL}?name=${encodeURIComponent(file.name)}`, {
    method: "POST",
    headers: { "Content-Type": "application/octet-stream" },
    body: file,
  });
  const answer = (await response.json().catch(() => ({}))) as Partial<UploadedAvatar> & { error?: string };
  if (!response.ok || typeof answer.id !== "string") {
    throw new Error(answer.error ?? `${file.name} was not taken (status ${response.status}).`);
  }
  return { id: answer.id, title: answer.title ?? file.name };
}

function megabytes(bytes: number): string {
  return (bytes / 1024 / 1024).toFixed(0);
}
