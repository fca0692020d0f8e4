/** Files that are too large to be sent are refused here, before a byte of them has travelled. */

import { MAX_SCENE, MAX_UPLOAD } from "../generated/messages";
import { text } from "../texts/texts";

const KILO = 1024;

/** Why a file is too large, in one sentence; "" where it is not. */
export function tooLarge({ name, size }: Pick<File, "name" | "size">): string {
  const most = /\.json$/i.test(name) ? MAX_SCENE : MAX_UPLOAD;
  return size > most ? text("file.tooLarge", name, told(size), told(most)) : "";
}

function told(bytes: number): string {
  return bytes < KILO * KILO ? `${Math.ceil(bytes / KILO)} kB` : `${Math.ceil(bytes / KILO / KILO)} MB`;
}
